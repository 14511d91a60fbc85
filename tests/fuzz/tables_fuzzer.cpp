// SPDX-License-Identifier: Apache-2.0
//
// Tables and edits: every input is read as each kind there is, as all but one must refuse it.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/differential/edit_reader.h"
#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/place_table.h"
#include "engine/io/edge_values.h"
#include "engine/io/number_table.h"
#include "engine/scene/model.h"
#include "engine/smooth/edge_widths.h"
#include "engine/smooth/vertex_widths.h"
#include "fuzz/fuzzer.h"
#include "fuzz/memory_file.h"

namespace limn::fuzz {

namespace {

/// A cube, whose elements tables name.
engine::Model MakeCube() {
    engine::Scene scene;
    scene.name = "cube";
    scene.cage.numVertices = 8;
    scene.cage.faceSizes.assign(6, 4);
    scene.cage.faceVertices = {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 7, 6,
                               6, 7, 1, 0, 1, 7, 5, 3, 6, 0, 2, 4};
    scene.positions = {0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1, 0, 1, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0};
    return engine::Model::Build(std::move(scene));
}

void ReadNumbers(std::string const& path) {
    auto const table =
        engine::ReadNumberTable(path, {{"face", "x", "y", "z"}, {"vertex", "x", "y", "z"}});
    Require(table.numColumns == 4 && table.values.size() == 4 * table.GetNumRows(),
            "a table has its columns in every row");
    for (double const value : table.values) Require(std::isfinite(value), "a table has numbers");
    for (size_t row = 0; row < table.GetNumRows(); ++row)
        engine::GetIndex(table, path, row, 0, 6, "face");
}

void EvaluatePlaces(std::string const& path, engine::Model const& cube) {
    auto const table = engine::ReadPlaces(path);
    engine::Job job;
    auto const values = engine::NamingRows(table, [&] {
        return engine::EvaluateLimit(cube, table.GetPlaces(), Orientation::Right, job);
    });
    Require(values.positions.size() == 3 * table.faces.size(), "every place has its point");
    Require(!engine::FormatValues(table.GetPlaces(), values, Precision::Double).empty(),
            "values are written");
}

/// What was read of a 1-form reads back the same.
void ReadForm(std::string const& path, engine::Model const& cube) {
    auto const& level = cube.GetLevel();
    std::vector<double> const form = engine::ReadEdgeValues(path, level);
    std::string const text = engine::FormatEdgeValues(level, form);
    MemoryFile const file({reinterpret_cast<uint8_t const*>(text.data()), text.size()});
    Require(MustSucceed("a 1-form that was read can be read again",
                        [&] { return engine::ReadEdgeValues(file.GetPath(), level); }) == form,
            "a 1-form reads back the same");
}

void ReadEdit(std::string const& path) {
    auto const edit = engine::ReadCurvatureEdit(path);
    for (auto const& factor : edit.factors)
        Require(std::isfinite(factor.factor), "factors are numbers");
    for (auto const& mean : edit.means) Require(std::isfinite(mean.mean), "means are numbers");
    for (auto const& [vertex, normal] : edit.normals)
        Require(std::hypot(normal[0], normal[1], normal[2]) > 0.0, "a normal has a direction");
    for (size_t i = 1; i < edit.filterPoints.size(); ++i)
        Require(edit.filterPoints[i][0] > edit.filterPoints[i - 1][0], "a filter's points rise");
    for (auto const& rotation : edit.rotations) {
        double const length = std::hypot(rotation.axis[0], rotation.axis[1], rotation.axis[2]);
        Require(std::isfinite(rotation.degrees) && length > 0.0, "a rotation has an axis");
    }
}

void ReadAll(std::string const& path) {
    static engine::Model const cube = MakeCube();
    Succeeds([&] { ReadNumbers(path); });
    Succeeds([&] { EvaluatePlaces(path, cube); });
    Succeeds([&] { ReadForm(path, cube); });
    Succeeds([&] { ReadEdit(path); });
    Succeeds([&] { engine::ReadVertexWidths(path, cube); });
    Succeeds([&] { engine::EdgeWidths::Read(path, cube); });
}

}  // namespace

}  // namespace limn::fuzz

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size) {
    using namespace limn::fuzz;
    UseOneThread();
    MemoryFile const file({data, size});
    ReadAll(file.GetPath());
    return 0;
}
