// SPDX-License-Identifier: Apache-2.0
#include "support/cascade_meshes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "far_ext/cascade/bisection.h"
#include "support/form_meshes.h"

namespace limn::test {

engine::Scene LoadMesh(std::string const& name) {
    engine::Scene scene = LoadData("cascade/" + name + ".obj");
    scene.cage.scheme = Sdc::SCHEME_LOOP;
    return scene;
}

bool IsManifold(engine::Scene const& scene) {
    auto const refiner = MakeRefiner(scene, 0);
    auto const base = refiner->GetLevel(0);
    for (Index i = 0; i < base.GetNumVertices(); ++i) {
        if (base.IsVertexNonManifold(i)) return false;
    }
    return true;
}

std::vector<std::pair<std::string, engine::Scene>> const& GetCascadeMeshes() {
    static auto const meshes = [] {
        auto all = MakeFormMeshes();
        for (auto const& name : ListShapes()) {
            auto const scene = LoadShape(name);
            if (IsManifold(scene)) all.emplace_back(name, scene);
        }
        return all;
    }();
    return meshes;
}

std::vector<double> ApplyParents(std::vector<int> const& offsets, std::vector<Index> const& parents,
                                 std::vector<double> const& coarse) {
    std::vector<double> fine(3 * (offsets.size() - 1), 0.0);
    for (size_t i = 0; i + 1 < offsets.size(); ++i) {
        for (int k = offsets[i]; k < offsets[i + 1]; ++k) {
            for (size_t c = 0; c < 3; ++c)
                fine[3 * i + c] +=
                    coarse[3 * static_cast<size_t>(parents[k]) + c] / (offsets[i + 1] - offsets[i]);
        }
    }
    return fine;
}

EdgeLengths MeasureEdges(engine::Scene const& scene) {
    auto const refiner = MakeRefiner(scene, 0);
    auto const level = refiner->GetLevel(0);
    EdgeLengths lengths;
    std::vector<double> counts(static_cast<size_t>(level.GetNumVertices()), 0.0);
    lengths.atVertices.assign(counts.size(), 0.0);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        double const* const p = &scene.positions[3 * static_cast<size_t>(ends[0])];
        double const* const q = &scene.positions[3 * static_cast<size_t>(ends[1])];
        double const length = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        lengths.mean += length / level.GetNumEdges();
        for (Index end : {ends[0], ends[1]}) {
            lengths.atVertices[static_cast<size_t>(end)] += length;
            counts[static_cast<size_t>(end)] += 1.0;
        }
    }
    for (size_t i = 0; i < counts.size(); ++i) lengths.atVertices[i] /= counts[i];
    return lengths;
}

std::list<far_ext::CascadeLevel> QuarterLevels(engine::Scene const& scene, int count,
                                               far_ext::BoundaryRule rule) {
    auto const refiner = MakeRefiner(scene, count);
    std::list<far_ext::CascadeLevel> levels;
    for (int k = 1; k <= count; ++k) {
        std::vector<Index> const coarse = k == 1 ? std::vector<Index>{} : levels.back().vertices;
        levels.push_back(
            far_ext::BuildCascadeLevel(far_ext::MakeCascadeMesh(*refiner, k), coarse, rule));
    }
    return levels;
}

std::list<far_ext::CascadeLevel> BisectLevels(engine::Scene const& scene, int count,
                                              far_ext::BoundaryRule rule) {
    far_ext::Bisection bisection(scene.cage.numVertices, scene.cage.faceVertices, scene.positions,
                                 {}, {});
    std::list<far_ext::CascadeLevel> levels;
    for (int k = 1; k <= count; ++k) {
        std::vector<Index> const coarse = k == 1 ? std::vector<Index>{} : levels.back().vertices;
        levels.push_back(far_ext::BuildCascadeLevel(bisection.Refine(), coarse, rule));
    }
    return levels;
}

std::vector<double> Filter(engine::Scene const& scene,
                           std::list<far_ext::CascadeLevel> const& levels,
                           eval::CascadeOptions const& options, std::vector<double> const& widths,
                           int finestSweeps) {
    eval::Cascade<double> cascade(scene.positions, widths, options);
    int left = static_cast<int>(levels.size());
    for (far_ext::CascadeLevel const& level : levels) {
        cascade.Step(level, eval::CountSweeps(options.solver, finestSweeps, --left, false));
    }
    return cascade.GetPositions();
}

far_ext::CascadeMesh MakeSameMesh(engine::Scene const& scene) {
    far_ext::CascadeMesh mesh;
    mesh.numVertices = scene.cage.numVertices;
    mesh.faceSize = scene.cage.faceSizes.empty() ? 3 : scene.cage.faceSizes.front();
    mesh.faces = scene.cage.faceVertices;
    for (Index i = 0; i < mesh.numVertices; ++i) {
        mesh.parents.push_back(i);
        mesh.parentOffsets.push_back(i + 1);
    }
    return mesh;
}

std::vector<double> Transform(std::vector<double> points, Eigen::Matrix3d const& matrix,
                              Eigen::Vector3d const& shift) {
    for (size_t i = 0; i < points.size(); i += 3) {
        Eigen::Map<Eigen::Vector3d> point(&points[i]);
        point = (matrix * point + shift).eval();
    }
    return points;
}

double MinAngleDegrees(std::vector<double> const& points, far_ext::CascadeMesh const& mesh) {
    double least = kPi;
    for (size_t corner = 0; corner < mesh.faces.size(); ++corner) {
        size_t const face = corner / 3 * 3, k = corner - face;
        Eigen::Vector3d const at = PointAt(points, mesh.faces[corner]);
        Eigen::Vector3d const a = PointAt(points, mesh.faces[face + (k + 1) % 3]) - at,
                              b = PointAt(points, mesh.faces[face + (k + 2) % 3]) - at;
        least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
    return least * 180 / kPi;
}

double MeanRadius(std::vector<double> const& points) {
    double sum = 0.0;
    for (size_t i = 0; i < points.size(); i += 3)
        sum += std::hypot(points[i], points[i + 1], points[i + 2]);
    return 3.0 * sum / static_cast<double>(points.size());
}

}  // namespace limn::test
