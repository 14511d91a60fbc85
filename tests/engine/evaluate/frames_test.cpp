// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/frames.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/place_table.h"
#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn::engine {
namespace {

namespace fs = std::filesystem;

/// A folder with a creased cage, frames of it that bend more and more, and places to evaluate.
class Frames : public testing::Test {
protected:
    static constexpr int kNumFrames = 12;

    void SetUp() override {
        mesh = test::LoadShape("catmark_tent_creases0");
        fs::create_directory(folder / "in");
        for (int frame = 1; frame <= kNumFrames; ++frame) WriteFrame(InputPath(frame), Bend(frame));
        for (Index face = 0; face < mesh.cage.GetNumFaces(); ++face) {
            faces.insert(faces.end(), 4, face);
            s.insert(s.end(), {0.25, 0.0, 0.875, 0.001});
            t.insert(t.end(), {0.5, 0.0, 0.75, 0.002});
        }
    }

    PlaceArrays GetPlaces() const { return {faces, s, t}; }

    std::string InputPath(int frame) const { return folder / fmt::format("in/walk.{}.obj", frame); }

    Scene Bend(int frame) const {
        Scene scene = mesh;
        for (size_t i = 0; i < scene.positions.size(); i += 3) {
            scene.positions[i + 2] += 0.1 * frame * std::sin(scene.positions[i] + 0.3 * frame);
        }
        return scene;
    }

    static void WriteFrame(std::string const& path, Scene const& scene) {
        WriteMesh(path, scene, Precision::Double);
    }

    FramesReport Evaluate(std::optional<eval::EvaluatorKind> evaluator = {},
                          std::string const& output = "out.{frame}.csv") {
        FrameOptions options;
        options.outputPattern = folder / output;
        options.precision = Precision::Double;
        std::optional<eval::TableEvaluator> door;
        if (evaluator) door.emplace(*evaluator);
        options.evaluator = door ? &*door : nullptr;
        Job job;
        return EvaluateFrames(Model::Build(mesh), GetPlaces(),
                              FindFrames(folder / "in/walk.{frame}.obj"), options, job);
    }

    static std::vector<double> ReadNumbers(std::string const& text) {
        std::vector<double> numbers;
        std::istringstream stream(text.substr(text.find('\n') + 1));
        for (std::string field; std::getline(stream, field, ',');) {
            std::istringstream lines(field);
            for (std::string number; lines >> number;) numbers.push_back(std::stod(number));
        }
        return numbers;
    }

    size_t CountOutputs() const {
        size_t count = 0;
        for (auto const& entry : fs::directory_iterator(folder / ""))
            count += entry.path().extension() != ".csv" ? 0 : 1;
        return count;
    }

    test::TemporaryFolder folder;
    Scene mesh;
    std::vector<Index> faces;
    std::vector<double> s, t;
};

TEST_F(Frames, AgreeWithEvaluatingEachAlone) {
    FramesReport const report = Evaluate();
    ASSERT_EQ(report.outputs.size(), kNumFrames);
    EXPECT_GT(report.numRows, faces.size() / 2);
    for (int frame = 1; frame <= kNumFrames; ++frame) {
        Job job;
        auto const values = EvaluateLimit(Model::Build(ReadMesh(InputPath(frame))), GetPlaces(),
                                          Orientation::Right, job);
        auto const expected = ReadNumbers(FormatValues(GetPlaces(), values, Precision::Double));
        auto const found = ReadNumbers(test::ReadText(folder / fmt::format("out.{}.csv", frame)));
        ASSERT_EQ(found.size(), expected.size());
        for (size_t i = 0; i < found.size(); ++i) {
            if (i % 16 >= 13) continue;  // the principal direction is free where k1 = k2
            EXPECT_NEAR(found[i], expected[i], 1e-9 * std::max(1.0, std::abs(expected[i])))
                << "frame " << frame << ", number " << i;
        }
    }
}

TEST_F(Frames, ComeInOrderOfTheirNumbers) {
    auto const frames = FindFrames(folder / "in/walk.{frame}.obj");
    ASSERT_EQ(frames.size(), kNumFrames);
    EXPECT_EQ(frames[1].name, "2");
    EXPECT_EQ(frames[11].name, "12");
    auto const all = FindFrames(folder / "in");
    ASSERT_EQ(all.size(), kNumFrames);
    EXPECT_EQ(all[0].name, "walk.1");
}

TEST_F(Frames, SameBytesWhateverTheThreads) {
    std::string first;
    for (size_t threads : {1, 2, 4}) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
        Evaluate();
        std::string const text = test::ReadText(folder / "out.7.csv");
        if (first.empty()) first = text;
        EXPECT_EQ(text, first);
    }
}

TEST_F(Frames, EvaluatorsInFloatAgreeOnPositions) {
    Evaluate();
    auto const expected = ReadNumbers(test::ReadText(folder / "out.5.csv"));
    for (auto kind : {eval::EvaluatorKind::Simd, eval::EvaluatorKind::OsdCpu}) {
        Evaluate(kind, "float.{frame}.csv");
        auto const found = ReadNumbers(test::ReadText(folder / "float.5.csv"));
        ASSERT_EQ(found.size(), expected.size());
        for (size_t i = 0; i < found.size(); ++i) {
            if (i % 16 >= 6) continue;  // curvatures feel float's rounding more
            EXPECT_NEAR(found[i], expected[i], 1e-5) << GetName(kind) << i;
        }
    }
}

/// The words of an error of the given code, which there must be.
template <class Work>
std::string ErrorOf(ErrorCode code, Work const& work) {
    auto const error = test::CatchError(work);
    EXPECT_TRUE(error) << "no error";
    if (!error) return {};
    EXPECT_EQ(error->GetCode(), code);
    return error->what();
}

TEST_F(Frames, AnotherTopologyIsNamedAndNothingIsWritten) {
    Scene other = Bend(9);
    std::swap(other.cage.faceVertices[4], other.cage.faceVertices[6]);
    WriteFrame(InputPath(9), other);
    std::string const message = ErrorOf(ErrorCode::BadMesh, [&] { Evaluate(); });
    EXPECT_NE(message.find("walk.9.obj"), std::string::npos) << message;
    EXPECT_NE(message.find("face 1"), std::string::npos) << message;
    EXPECT_EQ(CountOutputs(), 0u);

    WriteFrame(InputPath(9), test::MakeCube());
    EXPECT_NE(ErrorOf(ErrorCode::BadMesh, [&] { Evaluate(); }).find("8 vertices"),
              std::string::npos);
    test::WriteText(InputPath(9), "v 0 0 zero\n");
    EXPECT_NE(ErrorOf(ErrorCode::BadMesh, [&] { Evaluate(); }).find("walk.9.obj"),
              std::string::npos);
    EXPECT_EQ(CountOutputs(), 0u);
}

TEST_F(Frames, WrongNamesAreRefused) {
    ErrorOf(ErrorCode::BadOption, [&] { Evaluate({}, "out.csv"); });
    ErrorOf(ErrorCode::BadOption, [&] { Evaluate({}, "in/walk.{frame}.obj"); });
    ErrorOf(ErrorCode::BadOption, [&] { FindFrames(folder / "in/walk.obj"); });
    ErrorOf(ErrorCode::Io, [&] { FindFrames(folder / "in/run.{frame}.obj"); });
    ErrorOf(ErrorCode::Io, [&] { FindFrames(folder / "missing/walk.{frame}.obj"); });
    WriteFrame(folder / "in/walk.3.ply", Bend(3));
    EXPECT_NE(ErrorOf(ErrorCode::BadOption, [&] { FindFrames(folder / "in"); }).find("walk.3"),
              std::string::npos);
}

}  // namespace
}  // namespace limn::engine
