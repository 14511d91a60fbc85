// SPDX-License-Identifier: Apache-2.0
#include "engine/io/atomic_file.h"

#include <chrono>
#include <filesystem>
#include <regex>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/errors.h"
#include "support/files.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using engine::AtomicFile;
using Names = std::vector<std::string>;

class AtomicFiles : public testing::Test {
protected:
    test::TemporaryFolder folder;

    std::string FindTemporary() const {
        for (std::string const& name : folder.List()) {
            if (name.ends_with(".tmp")) return name;
        }
        return {};
    }
};

TEST_F(AtomicFiles, AppearsCompleteAndNotBefore) {
    AtomicFile file(folder / "a");
    file.Write("one ");
    file.Write("two");
    EXPECT_FALSE(fs::exists(folder / "a"));
    file.Commit();
    EXPECT_EQ(folder.List(), Names{"a"});
    EXPECT_EQ(test::ReadText(folder / "a"), "one two");
}

TEST_F(AtomicFiles, LeavesNothingWithoutACommit) {
    folder.Write("a", "older");
    AtomicFile(folder / "a").Write("newer");
    EXPECT_EQ(folder.List(), Names{"a"});
    EXPECT_EQ(test::ReadText(folder / "a"), "older");
}

TEST_F(AtomicFiles, TemporaryIsTheNameAndANonce) {
    AtomicFile const file(folder / "a.exr");
    EXPECT_TRUE(std::regex_match(FindTemporary(), std::regex("\\.a\\.exr\\.[0-9a-f]{32}\\.tmp")))
        << FindTemporary();
}

TEST_F(AtomicFiles, WritersOfOneFileNeverMeet) {
    AtomicFile first(folder / "a"), second(folder / "a");
    EXPECT_NE(first.GetPathToWrite(), second.GetPathToWrite());
    first.Write("first");
    second.Write("second");
    second.Commit();
    first.Commit();
    EXPECT_EQ(folder.List(), Names{"a"});
    EXPECT_EQ(test::ReadText(folder / "a"), "first");
}

TEST_F(AtomicFiles, NameMayHave255Bytes) {
    std::string const longest(255, 'n');
    engine::WriteFileAtomically(folder / longest, "x");
    EXPECT_EQ(folder.List(), Names{longest});
    EXPECT_EQ(test::RefusalOf([&] { AtomicFile(folder / (longest + "n")); }),
              fmt::format("'{}n' cannot be written: File name too long", folder / longest));
}

TEST_F(AtomicFiles, AllMissingFoldersAreMade) {
    engine::WriteFileAtomically(folder / "a/b/c/d", "x");
    EXPECT_EQ(test::ReadText(folder / "a/b/c/d"), "x");
}

TEST_F(AtomicFiles, FoldersMadeInVainGoAgain) {
    fs::create_directory(folder / "old");
    {
        AtomicFile const file(folder / "old/new/newer/a");
    }
    EXPECT_TRUE(fs::is_empty(folder / "old"));
    {
        AtomicFile const file(folder / "new/newer/a");
        folder.Write("new/b", "of somebody else");
    }
    EXPECT_EQ(folder.List(), (Names{"new", "old"}));
    EXPECT_FALSE(fs::exists(folder / "new/newer"));
}

TEST_F(AtomicFiles, FoldersThatCannotBeMadeLeaveNone) {
    // A name that no folder may have.
    std::string const path = folder / ("new/" + std::string(256, 'n') + "/a");
    EXPECT_EQ(test::CodeOf([&] { AtomicFile{path}; }), ErrorCode::Io);
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(AtomicFiles, FoldersThatNobodyCanMakeAreRefusedAtOnce) {
    fs::create_symlink("nowhere", folder / "dangling");
    for (std::string const& path : {folder / "dangling/sub/a", std::string("/proc/limn/sub/a")}) {
        EXPECT_EQ(test::RefusalOf([&] { AtomicFile{path}; }),
                  fmt::format("'{}' cannot be written: No such file or directory", path));
    }
    EXPECT_EQ(folder.List(), Names{"dangling"});
}

TEST_F(AtomicFiles, NameIsNotCutAtAZeroByte) {
    std::string const path = (folder / "a") + std::string(1, '\0') + ".exr";
    EXPECT_EQ(test::RefusalOf([&] { AtomicFile{path}; }),
              fmt::format("'{} .exr' cannot be written: a name holds no zero byte", folder / "a"));
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(AtomicFiles, FolderInItsPlaceIsRefusedAtOnce) {
    fs::create_directory(folder / "a");
    EXPECT_EQ(test::RefusalOf([&] { AtomicFile(folder / "a"); }),
              fmt::format("'{}' cannot be written: Is a directory", folder / "a"));
}

TEST_F(AtomicFiles, NameOfAFolderIsRefusedAtOnce) {
    EXPECT_EQ(test::RefusalOf([&] { AtomicFile(folder / "new/"); }),
              fmt::format("'{}' cannot be written: Is a directory", folder / "new/"));
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(AtomicFiles, FolderThatIsRemovedMeanwhileIsAnError) {
    AtomicFile file(folder / "new/a");
    file.Write("x");
    fs::remove_all(folder / "new");
    EXPECT_EQ(test::CodeOf([&] { file.Commit(); }), ErrorCode::Io);
}

TEST_F(AtomicFiles, LinksStayAndWhatTheyLeadToAppears) {
    fs::create_directory(folder / "there");
    fs::create_symlink("there/b", folder / "a");       // to nothing yet
    fs::create_symlink(folder / "a", folder / "far");  // through another one
    for (std::string const text : {"new", "newer"}) {
        engine::WriteFileAtomically(folder / "far", text);
        EXPECT_EQ(folder.List(), (Names{"a", "far", "there"}));
        EXPECT_TRUE(fs::is_symlink(folder / "a"));
        EXPECT_TRUE(fs::is_symlink(folder / "far"));
        EXPECT_EQ(test::ReadText(folder / "there/b"), text);
    }
}

TEST_F(AtomicFiles, LinksInACircleAreAnError) {
    fs::create_symlink("b", folder / "a");
    fs::create_symlink("a", folder / "b");
    EXPECT_EQ(test::CodeOf([&] { AtomicFile(folder / "a"); }), ErrorCode::Io);
    EXPECT_EQ(folder.List(), (Names{"a", "b"}));
}

TEST_F(AtomicFiles, PipesAreWrittenThrough) {
    std::string const pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::string heard;
    std::thread reader([&] { heard = test::ReadText(pipe); });
    engine::WriteFileAtomically(pipe, "through");
    reader.join();
    EXPECT_EQ(heard, "through");
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(folder.List(), Names{"pipe"});
}

TEST_F(AtomicFiles, DevicesAreWrittenThrough) {
    fs::create_symlink("/dev/null", folder / "null");
    engine::WriteFileAtomically(folder / "null", "x");
    EXPECT_TRUE(fs::is_symlink(folder / "null"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(test::RefusalOf([] { engine::WriteFileAtomically("/dev/full", "x"); }),
              "'/dev/full' cannot be written: No space left on device");
}

TEST_F(AtomicFiles, DescriptorsGoOnWhereTheyAre) {
    int const fd = ::open(folder.Write("log", "before\n").c_str(), O_WRONLY | O_APPEND);
    ASSERT_GE(fd, 0);
    engine::WriteFileAtomically(fmt::format("/dev/fd/{}", fd), "through\n");
    ASSERT_EQ(::write(fd, "after\n", 6), 6);
    ::close(fd);
    EXPECT_EQ(test::ReadText(folder / "log"), "before\nthrough\nafter\n");
    EXPECT_EQ(folder.List(), Names{"log"});
}

TEST_F(AtomicFiles, KindsOfOutputsAreTold) {
    using engine::FindOutputKind, engine::OutputKind;
    fs::create_symlink("/dev/null", folder / "null");
    fs::create_symlink("nothing", folder / "dangling");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    folder.Write("file", "x");
    for (char const* name : {"file", "dangling", "none", "no/such/folder"})
        EXPECT_EQ(FindOutputKind(folder / name), OutputKind::File) << name;
    EXPECT_EQ(FindOutputKind("/dev/null"), OutputKind::Null);
    EXPECT_EQ(FindOutputKind(folder / "null"), OutputKind::Null);
    for (std::string const& path : {std::string("/dev/full"), folder / "pipe"})
        EXPECT_EQ(FindOutputKind(path), OutputKind::Stream) << path;
}

TEST_F(AtomicFiles, SeveralAppearTogetherOrNotAtAll) {
    std::vector<std::unique_ptr<AtomicFile>> files;
    for (char const* name : {"new/a", "b/b", "c"})
        files.push_back(std::make_unique<AtomicFile>(folder / name));
    fs::remove_all(folder / "b");
    EXPECT_EQ(test::CodeOf([&] { engine::CommitTogether(files); }), ErrorCode::Io);
    files.clear();
    EXPECT_TRUE(folder.List().empty());

    for (char const* name : {"a", "c"})
        files.push_back(std::make_unique<AtomicFile>(folder / name));
    engine::CommitTogether(files);
    EXPECT_EQ(folder.List(), (Names{"a", "c"}));
}

/// What AbandonFiles does can be seen only in a process that ends.
TEST_F(AtomicFiles, AbandonedOnesGoAndTheThreadsThatWriteThemWait) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto const abandon = [&] {
        AtomicFile kept(folder / "kept"), dropped(folder / "new/dropped");
        engine::AbandonFiles(&kept);
        std::thread([&] { dropped.Commit(); }).detach();
        std::thread([&] { AtomicFile(folder / "late"); }).detach();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        kept.Write("x");
        kept.Commit();
        std::_Exit(7);
    };
    EXPECT_EXIT(abandon(), testing::ExitedWithCode(7), "");
}

class LeftTemporaries : public AtomicFiles {
protected:
    std::chrono::sys_seconds const now =
        std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());

    /// A file that was last written so many hours ago.
    void Write(std::string const& name, int hours) const {
        timespec const time{(now - std::chrono::hours(hours)).time_since_epoch().count(), 0};
        timespec const times[2]{time, time};
        ::utimensat(AT_FDCWD, folder.Write(name, "x").c_str(), times, 0);
    }
    Names Find() const {
        return engine::FindLeftTemporaries(folder.GetPath(), now - std::chrono::hours(24));
    }
};

TEST_F(LeftTemporaries, AreThoseOfADayAgo) {
    std::string const nonce(32, 'a');
    Write(".b.exr." + nonce + ".tmp", 25);
    Write(".a.exr." + nonce + ".tmp", 48);
    Write(".c.exr." + nonce + ".tmp", 23);
    EXPECT_EQ(Find(), (Names{folder / (".a.exr." + nonce + ".tmp"),
                             folder / (".b.exr." + nonce + ".tmp")}));
}

TEST_F(LeftTemporaries, AreNoneOfOtherPrograms) {
    std::string const nonce(32, 'a');
    for (std::string const& name :
         {"a.exr." + nonce + ".tmp", "." + nonce + ".tmp", ".a.exr." + nonce,
          ".a.exr." + nonce.substr(1) + ".tmp", ".a.exr." + nonce + "a.tmp",
          ".a.exr." + nonce.substr(1) + "A.tmp", std::string(".user.tmp")})
        Write(name, 48);
    EXPECT_TRUE(Find().empty());
}

TEST_F(LeftTemporaries, AreNoneThatSomebodyWrites) {
    AtomicFile const alive(folder / "a.exr");
    auto const name = FindTemporary();
    Write(name, 48);
    EXPECT_TRUE(Find().empty());
}

}  // namespace
}  // namespace limn
