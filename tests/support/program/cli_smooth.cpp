// SPDX-License-Identifier: Apache-2.0
#include "support/program/cli_smooth.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "support/refined.h"

namespace limn::test::cli {

std::string CliSmooth::WriteCube() const {
    std::string text;
    for (int i = 0; i < 8; ++i)
        text += fmt::format("v {} {} {}\n", i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    int const faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (int side = 0; side < 6; ++side) {
        for (auto const& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            text += fmt::format("vt {} {}\n", (side + 0.05 + 0.9 * u) / 6, 0.05 + 0.9 * v);
    }
    for (int side = 0; side < 6; ++side) {
        text += fmt::format("g side{}\nf", side);
        for (int k = 0; k < 4; ++k)
            text += fmt::format(" {}/{}", faces[side][k] + 1, 4 * side + k + 1);
        text += "\n";
    }
    return folder.Write("cube.obj", text);
}

engine::Scene CliSmooth::Smooth(std::string const& mesh, Words const& options,
                                std::string const& output) const {
    auto const outcome = Limn(Words{"smooth", mesh, "-o", folder / output, "--precision", "double",
                                    "--report", folder / "r.json"} +
                              options);
    if (outcome.status != 0) throw std::runtime_error(outcome.err);
    return engine::ReadMesh(folder / output);
}

std::vector<double> CliSmooth::Interpolate(engine::Scene scene, int levels) {
    bool const isLoop = std::all_of(scene.cage.faceSizes.begin(), scene.cage.faceSizes.end(),
                                    [](int size) { return size == 3; });
    scene.cage.scheme = isLoop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
    auto const refiner = test::MakeRefiner(scene, levels);
    std::vector<double> points = scene.positions;
    for (int level = 1; level <= levels; ++level) {
        auto const coarse = refiner->GetLevel(level - 1);
        std::vector<double> fine(3 * static_cast<size_t>(refiner->GetLevel(level).GetNumVertices()),
                                 0.0);
        auto const put = [&](Index child, auto const& parents) {
            for (size_t c = 0; c < 3; ++c) {
                double& value = fine[3 * static_cast<size_t>(child) + c];
                for (Index parent : parents) value += points[3 * static_cast<size_t>(parent) + c];
                value /= parents.size();
            }
        };
        for (Index i = 0; i < coarse.GetNumVertices(); ++i)
            std::copy_n(&points[3 * static_cast<size_t>(i)], 3,
                        &fine[3 * static_cast<size_t>(coarse.GetVertexChildVertex(i))]);
        for (Index i = 0; i < coarse.GetNumEdges(); ++i)
            put(coarse.GetEdgeChildVertex(i), coarse.GetEdgeVertices(i));
        for (Index i = 0; !isLoop && i < coarse.GetNumFaces(); ++i)
            put(coarse.GetFaceChildVertex(i), coarse.GetFaceVertices(i));
        points = fine;
    }
    return points;
}

Vector At(std::vector<double> const& points, size_t i) {
    return Vector(&points[3 * i]);
}

double MeasureVolume(engine::Scene const& scene) {
    double volume = 0.0;
    size_t corner = 0;
    for (int size : scene.cage.faceSizes) {
        for (int first : {0, size - 1}) {
            auto const at = [&](int i) {
                return At(
                    scene.positions,
                    static_cast<size_t>(
                        scene.cage.faceVertices[corner + static_cast<size_t>((first + i) % size)]));
            };
            for (int k = 1; k + 1 < size; ++k) volume += at(0).dot(at(k).cross(at(k + 1))) / 12;
        }
        corner += static_cast<size_t>(size);
    }
    return volume;
}

std::vector<float> GetWidths(engine::Scene const& scene) {
    for (auto const& primvar : scene.primvars) {
        if (primvar.name == "width") return primvar.values;
    }
    ADD_FAILURE() << "no width";
    return std::vector<float>(scene.positions.size() / 3, 0.0f);
}

}  // namespace limn::test::cli
