// SPDX-License-Identifier: Apache-2.0
#include "engine/io/number_table.h"

#include <regex>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"
#include "support/readers.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::NumberTable;

class Tables : public testing::Test {
protected:
    NumberTable Read(std::string const& text) const {
        return engine::ReadNumberTable(_folder.Write("t.csv", text), {{"face", "s", "t"}});
    }
    std::string RefusalOfText(std::string const& text) const {
        std::string const refusal = test::RefusalOf([&] { Read(text); });
        EXPECT_EQ(refusal.find(_folder / "t.csv"), 0u) << refusal;
        return refusal.substr((_folder / "t.csv").size());
    }

    std::string const kText = "face,s,t\n0,0.5,0.25\n7,1,+0\n";
    std::vector<double> const kValues{0, 0.5, 0.25, 7, 1, 0};

private:
    test::TemporaryFolder _folder;
};

TEST_F(Tables, ReadTheirColumnsInAnyOrder) {
    NumberTable const table = Read("note, t ,face,s\nx,0.25,0,0.5\n\ny,0,7,1\n");
    EXPECT_EQ(table.values, kValues);
    EXPECT_EQ(table.lines, (std::vector<size_t>{2, 4}));
}

TEST_F(Tables, ReadAnyLineEndAndMark) {
    for (std::string const end : {"\n", "\r\n", "\n\r", "\r"}) {
        for (std::string const mark : {"", "\xef\xbb\xbf"}) {
            NumberTable const table = Read(mark + std::regex_replace(kText, std::regex("\n"), end));
            EXPECT_EQ(table.values, kValues);
            EXPECT_EQ(table.lines, (std::vector<size_t>{2, 3}));
        }
    }
}

TEST_F(Tables, ReadSemicolonsQuotesAndCapitals) {
    EXPECT_EQ(Read("face;s;t\n0;0.5;0.25\n7;1;0\n").values, kValues);
    EXPECT_EQ(Read("\"face\", \"s\" ,\"t\"\n\"0\",0.5,\"0.25\"\n7,1,0\n").values, kValues);
    EXPECT_EQ(Read("FACE,S,T\n0,0.5,0.25\n7,1,0\n").values, kValues);
    EXPECT_EQ(Read("\"a \"\"b\"\", c\",Face,\"S\",t\n\"1,2\",0,0.5,0.25\n;,7,1,0\n").values,
              kValues);
}

TEST_F(Tables, PreferAColumnOfTheVeryNameToOneInCapitals) {
    EXPECT_EQ(Read("T,face,s,t\n9,0,0.5,0.25\n9,7,1,0\n").values, kValues);
}

TEST_F(Tables, ABackslashEndsNoLineEarly) {
    EXPECT_EQ(Read("face,s,t,folder\n0,0.5,0.25,C:\\\n7,1,0,D:\\\n").values, kValues);
}

TEST_F(Tables, RefuseWhatIsNoNumberByLineAndColumn) {
    EXPECT_EQ(RefusalOfText("face,s,t\n0,half,0\n"), ":2: 'half' in column s is no number");
    EXPECT_EQ(RefusalOfText("face,s,t\n0,0\n"), ":2: '' in column t is no number");
    EXPECT_EQ(RefusalOfText("face,s,t\n0,nan,0\n"), ":2: 'nan' in column s is no number");
    EXPECT_EQ(RefusalOfText("face,s,t\n0,1e999,0\n"),
              ":2: '1e999' in column s is too large a number; at most 1.79769e+308 in magnitude is "
              "possible");
    EXPECT_EQ(RefusalOfText("face,s,t\n0,0,1e-999\n"),
              ":2: '1e-999' in column t is too small a number; 0, or at least 4.94066e-324 in "
              "magnitude, is possible");
}

TEST_F(Tables, RefuseRowsWithMoreThanTheHeaderNames) {
    EXPECT_EQ(RefusalOfText("face,s,t\n0,0.5,0.25\n7,0,5,0\n"),
              ":3: the row has 4 fields; the header names 3 columns");
    EXPECT_EQ(RefusalOfText("note,face,s,t\na,0,0,1\nb,0,0,1,,more\n"),
              ":3: the row has 6 fields; the header names 4 columns");
    EXPECT_EQ(Read("face,s,t\n0,0.5,0.25,\n7,1,0 , ,\t\n").values, kValues) << "nothing is lost";
    EXPECT_EQ(RefusalOfText("face,s,t\n0,\"0.5\"1,0\n"),
              ":2: text stands behind the quote that ends a field");
}

TEST_F(Tables, RefuseDecimalCommas) {
    EXPECT_EQ(RefusalOfText("face;s;t\n0;0,5;0\n"),
              ":2: '0,5' in column s is no number; write a decimal point, not a comma");
}

TEST_F(Tables, RefuseOtherHeadersAndFiles) {
    EXPECT_EQ(RefusalOfText("face,u,v\n0,0,0\n"), ":1: the header needs the columns face,s,t");
    EXPECT_EQ(RefusalOfText("Face,FACE,s,t\n0,0,0,0\n"), ":1: the header has column 'face' twice");
    EXPECT_EQ(RefusalOfText("face,s,t,s\n0,0,0,1\n"), ":1: the header has column 's' twice");
    EXPECT_EQ(Read("x,face,x,s,t\n9,0,8,0.5,0.25\n9,7,8,1,0\n").values, kValues)
        << "what is skipped may have any name";
    EXPECT_EQ(RefusalOfText("\n\n"), ": the file is empty; a header face,s,t is needed");
    EXPECT_EQ(RefusalOfText("\"face,s,t\n"), ":1: a quoted field does not end on its line");
    EXPECT_EQ(RefusalOfText("PK\x03\x04"),
              ": looks like ZIP (USDZ, 3MF, a spreadsheet?): a table (CSV) is needed");
}

TEST_F(Tables, AreReadWholeOrRefusedHoweverDamaged) {
    int numRead = 0, numRefused = 0;
    for (unsigned seed = 0; seed < 500; ++seed) {
        std::string const text = test::Damage("\"face\",S,t\n0,0.5,0.25\n7,1,\"0\"\n", seed);
        auto const error = test::CatchError([&] {
            NumberTable const table = Read(text);
            EXPECT_EQ(table.values.size(), 3 * table.GetNumRows());
            EXPECT_TRUE(test::AreFinite(table.values));
        });
        if (!error) {
            ++numRead;
            continue;
        }
        EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh) << error->what();
        ++numRefused;
    }
    EXPECT_GT(numRead, 20);
    EXPECT_GT(numRefused, 50);
}

// "kind=a|b" is a column of words, told by their numbers.
TEST(WordsOfTables, AreNumbersInTheirOrder) {
    test::TemporaryFolder const folder;
    auto const read = [&](std::string const& text) {
        return engine::ReadNumberTable(folder.Write("t.csv", text), {{"v0", "kind=flux|turn"}});
    };
    EXPECT_EQ(read("kind,v0\nturn,3\nFlux,4\n").values, (std::vector<double>{3, 1, 4, 0}));
    EXPECT_NE(test::RefusalOf([&] { read("kind,v0\nturns,3\n"); }).find("t.csv:2"),
              std::string::npos);
    EXPECT_NE(test::RefusalOf([&] { read("v0\n3\n"); }).find("v0,kind"), std::string::npos);
}

}  // namespace
}  // namespace limn
