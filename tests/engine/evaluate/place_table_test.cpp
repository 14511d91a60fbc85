// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/place_table.h"

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Model;

TEST(PlaceTable, HasTheRowsOfTheFile) {
    test::TemporaryFolder const folder;
    auto const table =
        engine::ReadPlaces(folder.Write("p.csv", "t,face,note,s\n0.25,3,7,0.5\n\n1,0,7,0\n"));
    EXPECT_EQ(table.faces, (std::vector<Index>{3, 0}));
    EXPECT_EQ(table.s, (std::vector<double>{0.5, 0.0}));
    EXPECT_EQ(table.t, (std::vector<double>{0.25, 1.0}));
    EXPECT_EQ(table.lines, (std::vector<size_t>{2, 4}));
}

TEST(PlaceTable, NamesRowAndLineOfAPlaceThatIsRefused) {
    test::TemporaryFolder const folder;
    auto const table = engine::ReadPlaces(folder.Write("p.csv", "face,s,t\n0,0,0\n\n9,0,0\n"));
    Model const model = Model::Build(test::MakeCube());
    auto const locate = [&] { return engine::LocatePlaces(model, table.GetPlaces()); };
    EXPECT_EQ(test::RefusalOf(locate), "place 1: face 9 does not exist; faces are 0 to 5");
    EXPECT_EQ(test::RefusalOf([&] { engine::NamingRows(table, locate); }),
              folder / "p.csv" + ": row 1 (line 4): face 9 does not exist; faces are 0 to 5");
}

TEST(PlaceTable, AFaceInFractionsIsNoWholeNumber) {
    test::TemporaryFolder const folder;
    std::string const path = folder.Write("p.csv", "face,s,t\n0.5,0,0\n");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadPlaces(path); }),
              path + ":2: face 0.5 is no whole number");
}

TEST(PlaceTable, OtherErrorsPassUnchanged) {
    engine::PlaceTable const table;
    EXPECT_EQ(test::RefusalOf([&] {
                  engine::NamingRows(table, []() -> int { throw Error(ErrorCode::Io, "full"); });
              }),
              "full");
}

TEST(PlaceTable, ValuesHaveTheDigitsOfTheirPrecision) {
    Model const model = Model::Build(test::MakeCube());
    std::vector<Index> const faces{0};
    std::vector<double> const s{0.5}, t{1.0 / 3.0};
    engine::Job job;
    engine::PlaceArrays const places{faces, s, t};
    auto values = engine::EvaluateLimit(model, places, Orientation::Right, job);
    values.mean[0] = 2.0 / 3.0;
    auto const text = [&](Precision precision) {
        return engine::FormatValues(places, values, precision);
    };
    EXPECT_EQ(text(Precision::Float).find("face,s,t,px,py,pz,nx,ny,nz,mean,gaussian,k1,k2,"), 0u);
    EXPECT_NE(text(Precision::Float).find("\n0,0.5,0.3333333333333333,"), std::string::npos);
    EXPECT_NE(text(Precision::Float).find(",0.666666667,"), std::string::npos);
    EXPECT_NE(text(Precision::Double).find(",0.66666666666666663,"), std::string::npos);
}

}  // namespace
}  // namespace limn
