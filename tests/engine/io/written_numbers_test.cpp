// SPDX-License-Identifier: Apache-2.0
#include "engine/io/written_numbers.h"

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/files.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

engine::Scene MakeTorusAt(double distance) {
    engine::Scene torus = test::MakeTorus(12, 8);
    auto const noise = test::MakeNoise(torus.positions.size(), 3);
    for (size_t i = 0; i < noise.size(); ++i) torus.positions[i] += distance + 0.01 * noise[i];
    return torus;
}

TEST(WrittenNumbers, AreThoseThatAReaderFinds) {
    test::TemporaryFolder const folder;
    for (double distance : {0.0, 1e-3, 30.0, 5411932.5}) {
        for (std::string const name : {"a.obj", "b.OBJ", "c.ply"}) {
            for (Precision precision : {Precision::Float, Precision::Double}) {
                engine::Scene mesh = MakeTorusAt(distance);
                engine::Scene const exact = mesh;
                engine::RoundAsWritten(name, precision, mesh.positions);
                EXPECT_EQ(mesh.positions == exact.positions, precision == Precision::Double);
                engine::WriteMesh(folder / name, exact, precision);
                EXPECT_EQ(engine::ReadMesh(folder / name).positions, mesh.positions);
                engine::WriteMesh(folder / name, mesh, precision);
                EXPECT_EQ(engine::ReadMesh(folder / name).positions, mesh.positions);
            }
        }
    }
}

struct Choice {
    Precision precision;
    std::vector<std::string> warnings;
};

Choice ChooseAt(double distance, std::optional<Precision> wanted,
                double share = engine::kMostRounded) {
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    auto const extent = engine::FindExtent(MakeTorusAt(distance).positions);
    Precision const precision = engine::ChoosePrecision({"a.obj", wanted}, extent, job, share);
    return {precision, listener.warnings};
}

TEST(WrittenNumbers, AreFloatsNearTheOriginAndDoublesFarFromIt) {
    Choice const near = ChooseAt(0.0, {});
    EXPECT_EQ(near.precision, Precision::Float);
    EXPECT_TRUE(near.warnings.empty());

    Choice const far = ChooseAt(5411932.5, {});
    EXPECT_EQ(far.precision, Precision::Double);
    ASSERT_EQ(far.warnings.size(), 1u);
    EXPECT_TRUE(far.warnings[0].starts_with("a.obj: in double, for floats are off by up to 0.32,"))
        << far.warnings[0];
}

TEST(WrittenNumbers, AreDoublesNearTheOriginWhereMoreIsAskedFor) {
    EXPECT_EQ(ChooseAt(0.0, {}, 1e-9).precision, Precision::Double);
    EXPECT_EQ(ChooseAt(0.0, {}, 1e-9).warnings.size(), 1u);
}

TEST(WrittenNumbers, AreWhatWasAskedForWithAWordWhereThatLoses) {
    EXPECT_EQ(ChooseAt(5411932.5, Precision::Double).precision, Precision::Double);
    EXPECT_TRUE(ChooseAt(5411932.5, Precision::Double).warnings.empty());
    Choice const far = ChooseAt(5411932.5, Precision::Float);
    EXPECT_EQ(far.precision, Precision::Float);
    ASSERT_EQ(far.warnings.size(), 1u);
    EXPECT_TRUE(far.warnings[0].ends_with("`precision` double keeps it all")) << far.warnings[0];
    EXPECT_TRUE(ChooseAt(0.0, Precision::Float).warnings.empty());
}

TEST(WrittenNumbers, LeaveWhatIsNoFloatToTheWriter) {
    std::vector<double> positions{1e39, -1e300, 0.1};
    engine::RoundAsWritten("a.ply", Precision::Float, positions);
    EXPECT_EQ(positions, (std::vector<double>{1e39, -1e300, 0.1f}));
}

}  // namespace
}  // namespace limn
