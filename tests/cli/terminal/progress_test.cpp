// SPDX-License-Identifier: Apache-2.0
//
// The bar on a terminal, and what is told where there is none.

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "engine/cli/console.h"
#include "support/program/cli.h"

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

    int GetProgramEnd() const { return _program; }

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

/// What a console shows on the terminal of a phase that takes longer than a short one may.
std::string ShowPhaseOn(Terminal const& terminal, char const* kind = "xterm",
                        char const* columns = nullptr) {
    ::setenv("TERM", kind, 1);
    columns ? ::setenv("COLUMNS", columns, 1) : ::unsetenv("COLUMNS");
    int const stderrOfTest = ::dup(STDERR_FILENO);
    ::dup2(terminal.GetProgramEnd(), STDERR_FILENO);
    {
        cli::Console console(std::nullopt, cli::Console::Detail::Usual);
        auto const tell = console.MakeHost([] { return false; }).onProgress;
        tell({"baking spot", 0, 10});
        std::this_thread::sleep_for(std::chrono::milliseconds(510));
        tell({"baking spot", 5, 10});
        tell({"baking spot", 10, 10, true});
    }
    ::dup2(stderrOfTest, STDERR_FILENO);
    ::close(stderrOfTest);
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
        std::string const shown = ShowPhaseOn(Terminal(columns));
        EXPECT_TRUE(Contains(shown, " %  ")) << shown;
        EXPECT_TRUE(Contains(shown, " left")) << shown;
        EXPECT_LT(FindWidth(shown), columns) << shown;
    }
}

TEST(CliProgress, ColumnsOfTheUserAreKept) {
    EXPECT_LT(FindWidth(ShowPhaseOn(Terminal(100), "xterm", "40")), 40);
}

TEST(CliProgress, IsInLinesWhereABarHasNoPlace) {
    for (auto const& shown : {ShowPhaseOn(Terminal(19)), ShowPhaseOn(Terminal(80), "dumb")}) {
        EXPECT_TRUE(Contains(shown, "limn: baking spot: 100 %, ")) << shown;
        EXPECT_FALSE(Contains(shown, "[=")) << shown;
    }
}

TEST_F(Cli, ProgressIsInLinesWhereStderrIsNoTerminalEvenIfABarIsAskedFor) {
    Outcome const outcome = Limn({"bake", test::ScenePath("spot/spot.obj"), "-o", folder / "a.exr",
                                  "--maps", "curvature,normal", "--size", "1k", "--samples", "2",
                                  "--threads", "1", "--progress", "bar"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_FALSE(Contains(outcome.err, "\r")) << outcome.err;
    EXPECT_FALSE(Contains(outcome.err, "[=")) << outcome.err;
}

}  // namespace
}  // namespace limn
