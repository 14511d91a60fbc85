// SPDX-License-Identifier: Apache-2.0
//
// What happens to a run, and what is left of it: killed, out of room, out of memory, together with
// others. What needs rights that not every user has is skipped by name.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/images/exr_seal.h"
#include "support/program/cli.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;
using std::chrono::milliseconds;

class Faults : public Cli {
protected:
    std::string const cube = Shape("catmark_cube");

    Words MakeBake(std::string const& output, Words const& more = {}) const {
        return Words{LIMN_PROGRAM, "bake",   cube,     "-o",  output,
                     "--maps",     "normal", "--size", "256", "--quiet"} +
               more;
    }

    Words ListTemporaries() const {
        Words names = folder.List();
        std::erase_if(names, [](std::string const& name) { return !name.ends_with(".tmp"); });
        return names;
    }
};

TEST_F(Faults, KilledAtAnyMomentThereIsNoBrokenFile) {
    std::mt19937 random(1);
    for (int run = 0; run < 30; ++run) {
        fs::remove(folder / "a.exr");
        size_t const before = ListTemporaries().size();
        {
            test::Process process(MakeBake(folder / "a.exr"));
            std::this_thread::sleep_for(milliseconds(random() % 60));
            process.Send(SIGKILL);
            process.Wait();
        }
        EXPECT_TRUE(!fs::exists(folder / "a.exr") || engine::CheckSeal(folder / "a.exr"));
        EXPECT_LE(ListTemporaries().size(), before + 1);
    }
    // The next run works beside what the others have left, which may be somebody else's.
    Words const left = ListTemporaries();
    EXPECT_EQ(test::Process(MakeBake(folder / "a.exr")).Wait().status, 0);
    EXPECT_TRUE(engine::CheckSeal(folder / "a.exr"));
    EXPECT_EQ(ListTemporaries(), left);
}

TEST_F(Faults, TemporariesOfADayAgoAreNamedInOneWarning) {
    std::string const nonce(32, '0');
    auto const old = fs::file_time_type::clock::now() - std::chrono::hours(25);
    Words names;
    for (char const* name : {".a.exr.", ".b.exr.", ".c.exr.", ".d.exr."}) {
        names.push_back(name + nonce + ".tmp");
        fs::last_write_time(folder.Write(names.back(), "x"), old);
    }
    Outcome const outcome = Limn({"bake", cube, Shape("catmark_torus"), "-o", folder / "{mesh}.exr",
                                  "--maps", "mean", "--size", "32", "--progress", "none"});
    ASSERT_EQ(outcome.status, 0);
    auto const lines = Lines(outcome.err);
    ASSERT_EQ(lines.size(), 1u) << outcome.err;
    EXPECT_TRUE(Contains(lines[0], "limn: warning: runs that were killed")) << lines[0];
    EXPECT_TRUE(Contains(lines[0], names[0])) << lines[0];
    EXPECT_TRUE(Contains(lines[0], "and 1 more")) << lines[0];
    EXPECT_EQ(ListTemporaries(), names);
}

TEST_F(Faults, TwoWritersOfOneFileBothEndWell) {
    test::Process first(MakeBake(folder / "new/a.exr")), second(MakeBake(folder / "new/a.exr"));
    EXPECT_EQ(first.Wait().status, 0);
    EXPECT_EQ(second.Wait().status, 0);
    EXPECT_TRUE(engine::CheckSeal(folder / "new/a.exr"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "new"), {}), 1);
}

TEST_F(Faults, FolderThatIsRemovedIsStatus5) {
    test::Process process(MakeBake(folder / "new/a.exr", {"--samples", "8"}));
    while (!fs::exists(folder / "new") || fs::is_empty(folder / "new"))
        std::this_thread::sleep_for(milliseconds(1));
    fs::remove_all(folder / "new");
    ExpectError(process.Wait(), 5, "cannot be written: No such file or directory");
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Faults, ManyOutputsNeedFewDescriptors) {
    std::string const frames =
        "for i in $(seq 100); do cp " + cube + " " + folder / "in.$i.obj" + "; done; ";
    std::string const limn = "ulimit -n 64; exec " LIMN_PROGRAM;
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    for (std::string const& script :
         {limn + " morph " + cube + " " + cube + " --steps 100 -o " + folder / "m",
          frames + limn + " eval " + cube + " --at " + places + " --frames '" + folder.GetPath() +
              "/in.{frame}.obj' -o '" + folder.GetPath() + "/out.{frame}.csv'"}) {
        Outcome const outcome = test::Process({"/bin/sh", "-c", script}).Wait();
        EXPECT_EQ(outcome.status, 0) << outcome.err;
    }
}

TEST_F(Faults, TooLittleMemoryIsStatus1) {
    int numRefused = 0, status = -1;
    for (size_t megabytes = 32; status != 0 && megabytes <= 512; megabytes += megabytes / 3) {
        Outcome const outcome = test::Process(MakeBake(folder / "a.exr", {"--threads", "1"}),
                                              {.maxMemoryBytes = megabytes << 20})
                                    .Wait();
        status = outcome.status;
        EXPECT_TRUE(ListTemporaries().empty()) << megabytes;
        constexpr int kNotEvenLoaded = 127;
        if (status == 0 || status == kNotEvenLoaded) continue;
        ExpectError(outcome, 1, "out of memory");
        ++numRefused;
    }
    EXPECT_GT(numRefused, 0);
    EXPECT_EQ(status, 0);
}

// ---- What needs a world of one's own

/// A command for a shell.
std::string Quote(Words const& words) {
    std::string line;
    for (std::string const& word : words) line += "'" + word + "' ";
    return line;
}

/// A shell in namespaces of its own.
Outcome RunApart(char const* namespaces, std::string const& script) {
    return test::Process({"/usr/bin/unshare", namespaces, "--fork", "/bin/sh", "-c", script})
        .Wait();
}

bool CanBeApart(char const* namespaces, std::string const& script) {
    return fs::exists("/usr/bin/unshare") && RunApart(namespaces, script).status == 0;
}

/// A folder on a file system that the test makes for itself.
class SmallDisk : public Faults {
protected:
    void SetUp() override {
        if (!CanBeApart("--mount", "mount -t tmpfs tmpfs " + folder.GetPath()))
            GTEST_SKIP() << "needs the right to mount a file system";
    }

    /// Runs limn there, and lists what it leaves after a line of dashes.
    Outcome Run(std::string const& options, Words const& words,
                std::string const& before = "true") const {
        std::string const disk = folder.GetPath();
        return RunApart("--mount",
                        fmt::format("mount -t tmpfs -o {} tmpfs {} && cd {} && {} && "
                                    "{{ {}; status=$?; echo ---; ls -A; exit $status; }}",
                                    options, disk, disk, before, Quote(words)));
    }

    static void ExpectNothingLeft(Outcome const& outcome) {
        EXPECT_TRUE(outcome.out.ends_with("---\n")) << outcome.out;
    }
};

TEST_F(SmallDisk, FullIsStatus5AndNothingIsLeft) {
    for (char const* compression : {"none", "zip", "piz"}) {
        Outcome const outcome =
            Run("size=64k", MakeBake("new/a.exr", {"--compression", compression}));
        ExpectError(outcome, 5, "No space left on device");
        ExpectNothingLeft(outcome);
    }
    Outcome const outcome =
        Run("size=64k", {LIMN_PROGRAM, "refine", cube, "-o", "a.obj", "--levels", "5"});
    ExpectError(outcome, 5, "No space left on device");
    ExpectNothingLeft(outcome);
}

// Whatever is the last to be written: pixels, the index, or a picture.
TEST_F(SmallDisk, FullAtAnyMomentIsStatus5) {
    for (int kilobytes = 8; kilobytes <= 72; kilobytes += 8) {
        Outcome const outcome = Run(
            fmt::format("size={}k", kilobytes),
            Words{LIMN_PROGRAM, "bake", cube, "-o", "a.exr", "--maps", "normal", "--size", "64",
                  "--quiet", "--preview", "--compression", kilobytes % 16 == 0 ? "piz" : "zip"});
        if (outcome.status == 0) continue;
        ExpectError(outcome, 5, "No space left on device");
        ExpectNothingLeft(outcome);
    }
}

TEST_F(SmallDisk, OutOfInodesIsStatus5AndNothingIsLeft) {
    Outcome const outcome = Run("nr_inodes=2", MakeBake("a.exr", {"--preview"}));
    ExpectError(outcome, 5, "No space left on device");
    ExpectNothingLeft(outcome);
}

TEST_F(SmallDisk, ReadOnlyIsStatus5) {
    Outcome const outcome =
        Run("size=1m", MakeBake("a.exr"), "mount -o remount,ro " + folder.GetPath());
    ExpectError(outcome, 5, "Read-only file system");
    ExpectNothingLeft(outcome);
}

/// Two processes of one number, as two containers on one machine have them.
TEST_F(Faults, SameProcessNumbersDoNotMeet) {
    if (!CanBeApart("--pid", "true")) GTEST_SKIP() << "needs the right to make process namespaces";
    std::string const line = Quote({LIMN_PROGRAM, "bake", cube, "-o", folder / "{map}.exr",
                                    "--maps", "mean,normal,k1,k2", "--size", "128", "--quiet"});
    std::vector<std::thread> writers;
    std::vector<Outcome> outcomes(4);
    for (Outcome& outcome : outcomes)
        writers.emplace_back([&] { outcome = RunApart("--pid", line); });
    for (std::thread& writer : writers) writer.join();
    for (Outcome const& outcome : outcomes) EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(folder.List(), (Words{"k1.exr", "k2.exr", "mean.exr", "normal.exr"}));
    for (std::string const& name : folder.List()) EXPECT_TRUE(engine::CheckSeal(folder / name));
}

}  // namespace
}  // namespace limn
