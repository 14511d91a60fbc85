// SPDX-License-Identifier: Apache-2.0
#include "engine/io/text_scanner.h"

#include <regex>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn {
namespace {

using engine::TextScanner;

std::string const kPath = "a.txt";

struct Line {
    uint32_t number;
    std::string text;

    bool operator==(Line const&) const = default;
};

void PrintTo(Line const& line, std::ostream* out) {
    *out << line.number << ": '" << line.text << "'";
}

std::vector<Line> ReadLines(std::string_view text,
                            TextScanner::Backslash backslash = TextScanner::Backslash::IsText) {
    TextScanner scan(text, kPath, backslash);
    std::vector<Line> lines;
    while (scan.NextLine()) lines.push_back({scan.GetLineNumber(), std::string(scan.RestOfLine())});
    return lines;
}

std::vector<Line> ReadJoined(std::string_view text) {
    return ReadLines(text, TextScanner::Backslash::JoinsLines);
}

TEST(TextScanner, AllKindsOfLineEndsGiveTheSameLines) {
    std::string const text = "one\n\ntwo 2\n\n\nthree";
    std::vector<Line> const expected{{1, "one"}, {2, ""}, {3, "two 2"},
                                     {4, ""},    {5, ""}, {6, "three"}};
    for (std::string const end : {"\n", "\r\n", "\n\r", "\r"}) {
        for (std::string const last : {"", "\n"}) {
            std::string const other = std::regex_replace(text + last, std::regex("\n"), end);
            EXPECT_EQ(ReadLines(other), expected) << testing::PrintToString(other);
        }
    }
}

TEST(TextScanner, AFileMayMixLineEnds) {
    EXPECT_EQ(ReadLines("a\r\nb\n\r\nc\rd\n"),
              (std::vector<Line>{{1, "a"}, {2, "b"}, {3, ""}, {4, "c"}, {5, "d"}}));
}

TEST(TextScanner, Utf8MarkIsNoPartOfTheText) {
    EXPECT_EQ(ReadLines("\xef\xbb\xbfone\ntwo"), (std::vector<Line>{{1, "one"}, {2, "two"}}));
    EXPECT_TRUE(ReadLines("\xef\xbb\xbf").empty());
}

TEST(TextScanner, Utf16IsRefusedByName) {
    for (std::string const text : {"\xff\xfe"
                                   "a",
                                   "\xfe\xff"
                                   "a"}) {
        EXPECT_EQ(test::RefusalOf([&] { ReadLines(text); }),
                  "a.txt:1: this is not text in ASCII or UTF-8 but in UTF-16; UTF-8 is needed");
    }
}

TEST(TextScanner, BackslashesJoinLinesThatKeepTheirNumbers) {
    std::vector<Line> const expected{{1, "f 1 2  3  4"}, {4, "next"}};
    EXPECT_EQ(ReadJoined("f 1 2\\\n 3\\\n 4\nnext\n"), expected);
    EXPECT_EQ(ReadJoined("f 1 2\\\r\n 3\\\r\n 4\r\nnext\r\n"), expected);
    EXPECT_EQ(ReadLines("a\\\nb"), (std::vector<Line>{{1, "a\\"}, {2, "b"}}));
}

TEST(TextScanner, BlanksBehindABackslashChangeNothing) {
    std::vector<Line> const expected{{1, "f 1 2  3  4"}, {4, "next"}};
    EXPECT_EQ(ReadJoined("f 1 2\\ \n 3\\\t \n 4\nnext\n"), expected);
    EXPECT_EQ(ReadJoined("f 1 2\\ \r\n 3\\\t\r\n 4\r\nnext\r\n"), expected);
    EXPECT_EQ(ReadJoined("g a\\ b\nf 1\n \nf 2"),
              (std::vector<Line>{{1, "g a\\ b"}, {2, "f 1"}, {3, ""}, {4, "f 2"}}));
}

TEST(TextScanner, ABackslashPartsWordsThatLinesEndAndBeginWith) {
    EXPECT_EQ(ReadJoined("1\\\n2"), (std::vector<Line>{{1, "1 2"}}));
}

TEST(TextScanner, ABackslashInACommentJoinsNothing) {
    EXPECT_EQ(
        ReadJoined("# C:\\meshes\\\nv 1\nf 1 # last \\\nv 2"),
        (std::vector<Line>{{1, "# C:\\meshes\\"}, {2, "v 1"}, {3, "f 1 # last \\"}, {4, "v 2"}}));
}

TEST(TextScanner, ABackslashAtTheEndOfTheFileJoinsNothing) {
    EXPECT_EQ(ReadJoined("f 1 2\\"), (std::vector<Line>{{1, "f 1 2"}}));
    EXPECT_EQ(ReadJoined("f 1 2\\\n"), (std::vector<Line>{{1, "f 1 2"}}));
}

// A search for the kind of line end that a file does not have must not start anew in every line.
TEST(TextScanner, ManyLinesTakeTimeInProportion) {
    for (std::string const end : {"\n", "\r", "\n\r", "\\\n"}) {
        std::string text;
        for (int i = 0; i < 2000000; ++i) text += "v" + end;
        EXPECT_EQ(ReadJoined(text).size(), end == "\\\n" ? 1u : 2000000u);
    }
}

TEST(TextScanner, BytesBehindALineBeginWhereItsEndIsLikeTheFirstLines) {
    auto const behind = [](std::string const& text) {
        TextScanner scan(text, kPath);
        scan.NextLine();
        scan.NextLine();
        return std::string(scan.GetBytesBehind());
    };
    EXPECT_EQ(behind("ply\nend\n\rdata"), "\rdata");
    EXPECT_EQ(behind("ply\rend\r\ndata"), "\ndata");
    EXPECT_EQ(behind("ply\r\nend\r\ndata"), "data");
    EXPECT_EQ(behind("ply\n\rend\n\rdata"), "data");
    EXPECT_EQ(behind("ply\nend"), "");
    EXPECT_EQ(behind("ply\r\nend\ndata"), "data");
}

TEST(TextScanner, NumbersMayHaveAPlusButNotTwoSigns) {
    std::string const text = "+1.5 +-2";
    TextScanner scan(text, kPath);
    scan.NextLine();
    EXPECT_EQ(scan.Number("x"), 1.5);
    EXPECT_EQ(scan.TryNumber(), std::nullopt);
    EXPECT_EQ(scan.Word(), "+-2");
}

}  // namespace
}  // namespace limn
