// SPDX-License-Identifier: Apache-2.0
//
// The bar on a terminal, and what is told where there is none.

#include <algorithm>
#include <stdexcept>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "support/cli.h"

namespace limn {
namespace {

using namespace test::cli;

/// A terminal of so many columns, that a program may have as its stderr.
class Terminal {
public:
    explicit Terminal(int columns) : _master(::posix_openpt(O_RDWR | O_NOCTTY)) {
        if (_master < 0 || ::grantpt(_master) != 0 || ::unlockpt(_master) != 0)
            throw std::runtime_error("no terminal");
        _program = ::open(::ptsname(_master), O_RDWR | O_NOCTTY);
        winsize const size{24, static_cast<unsigned short>(columns), 0, 0};
        ::ioctl(_program, TIOCSWINSZ, &size);
    }
    ~Terminal() {
        ::close(_program);
        ::close(_master);
    }
    Terminal(Terminal const&) = delete;
    Terminal& operator=(Terminal const&) = delete;

    std::string GetPath() const { return ::ptsname(_master); }

    /// What has been written so far.
    std::string Read() const {
        std::string text;
        char block[4096];
        pollfd waiting{_master, POLLIN, 0};
        while (::poll(&waiting, 1, 0) == 1) {
            ssize_t const count = ::read(_master, block, sizeof(block));
            if (count <= 0) break;
            text.append(block, static_cast<size_t>(count));
        }
        return text;
    }

private:
    int _master, _program = -1;
};

/// A bake of about a second, with its stderr on a terminal.
std::string BakeOn(Terminal const& terminal, std::string const& variables = "TERM=xterm") {
    test::TemporaryFolder const folder;
    std::string const command = "env -u COLUMNS " + variables + " " LIMN_PROGRAM " bake " +
                                test::ScenePath("spot/spot.obj") + " -o " + (folder / "{map}.exr") +
                                " --maps curvature,normal --size 1k --samples 2 --threads 1 2>" +
                                terminal.GetPath();
    EXPECT_EQ(test::Process({"/bin/sh", "-c", command}).Wait().status, 0);
    return terminal.Read();
}

/// The most columns that a line takes, each as often as it was written.
int FindWidth(std::string text) {
    std::ranges::replace(text, '\r', '\n');
    size_t width = 0;
    for (std::string const& line : Lines(text)) width = std::max(width, line.size());
    return static_cast<int>(width);
}

TEST(CliProgress, BarFitsItsTerminal) {
    for (int columns : {20, 37, 100}) {
        Terminal const terminal(columns);
        std::string const shown = BakeOn(terminal);
        EXPECT_TRUE(Contains(shown, " %  ")) << shown;
        EXPECT_TRUE(Contains(shown, " left")) << shown;
        EXPECT_LT(FindWidth(shown), columns) << shown;
    }
}

TEST(CliProgress, ColumnsOfTheUserAreKept) {
    Terminal const terminal(100);
    EXPECT_LT(FindWidth(BakeOn(terminal, "TERM=xterm COLUMNS=40")), 40);
}

TEST(CliProgress, IsInLinesWhereABarHasNoPlace) {
    Terminal const narrow(19), wide(80);
    for (auto const& shown : {BakeOn(narrow), BakeOn(wide, "TERM=dumb")}) {
        EXPECT_TRUE(Contains(shown, "limn: baking spot: 100 %, ")) << shown;
        EXPECT_FALSE(Contains(shown, "[=")) << shown;
    }
}

TEST_F(Cli, ProgressIsInLinesWhereStderrIsNoTerminalEvenIfABarIsAskedFor) {
    Outcome const outcome = Limn({"bake", test::ScenePath("spot/spot.obj"), "-o", folder / "a.exr",
                                  "--maps", "curvature,normal", "--size", "1k", "--samples", "2",
                                  "--threads", "1", "--progress", "bar"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(Contains(outcome.err, "limn: baking spot: 100 %, ")) << outcome.err;
    EXPECT_FALSE(Contains(outcome.err, "\r")) << outcome.err;
}

}  // namespace
}  // namespace limn
