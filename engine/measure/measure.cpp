// SPDX-License-Identifier: Apache-2.0
#include "engine/measure/measure.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include "engine/scene/require_limit.h"
#include "engine/scene/subdivision_names.h"
#include "eval/parallel/rows.h"
#include "eval/surface/surface_integrals.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/face_components.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;
constexpr double kPi = 3.14159265358979323846;

using eval::SurfaceSums;

CurvatureStatistics MakeStatistics(SurfaceSums const& sums, double sum, double squares, double min,
                                   double max) {
    if (sums.count == 0 || !(sums.area > 0.0)) return {};
    double const mean = sum / sums.area;
    return {min, max, mean, std::sqrt(std::max(0.0, squares / sums.area - mean * mean))};
}

class Surveyor {
public:
    Surveyor(Model const& model, Orientation orientation, Job& job)
        : _model(model),
          _level(model.GetLevel()),
          _orientation(orientation),
          _job(job),
          _components(far_ext::FaceComponents::Find(_level)) {}

    std::vector<SurfaceSums> SurveyLimit() const;
    std::vector<SurfaceSums> SurveyMesh() const;
    Measurement Conclude(std::vector<SurfaceSums> const& ofComponents,
                         MeasuredSurface surface) const;

private:
    std::vector<std::string> FindReasons(MeasuredSurface surface) const;
    bool EnclosesVolume() const;

    Model const& _model;
    Level const& _level;
    Orientation _orientation;
    Job& _job;
    far_ext::FaceComponents _components;
};

/// Sums of faces, added in order: the same bits whatever the threads.
std::vector<SurfaceSums> Surveyor::SurveyLimit() const {
    eval::LimitSurface const surface(_model.GetRefiner());
    eval::RingCache rings(_model.GetCage().scheme, _model.GetRefiner().GetSchemeOptions(),
                          eval::LimitSurface::kMostRingBytes);
    tbb::enumerable_thread_specific<eval::SurfaceIntegrator> integrators([&] {
        return eval::SurfaceIntegrator(surface, _model.GetPositions(), _orientation, rings);
    });
    struct Run {  // of faces of one component
        int component;
        SurfaceSums sums;
    };
    constexpr Index kFacesPerBlock = 16384;  // enough for most lanes to be taken
    auto const ofBlocks =
        eval::MapBlocks(surface.GetNumFaces(), kFacesPerBlock, [&](Index begin, Index end) {
            _job.CheckStopped();
            std::vector<SurfaceSums> ofFaces(static_cast<size_t>(end - begin));
            integrators.local().Integrate(begin, end, ofFaces);
            std::vector<Run> runs;
            for (Index face = begin; face < end; ++face) {
                int const component = _components.ofFace[face];
                if (runs.empty() || runs.back().component != component)
                    runs.push_back({component, {}});
                runs.back().sums.Add(ofFaces[face - begin]);
            }
            return runs;
        });
    std::vector<SurfaceSums> ofComponents(static_cast<size_t>(_components.count));
    for (auto const& runs : ofBlocks) {
        for (Run const& run : runs) ofComponents[run.component].Add(run.sums);
    }
    return ofComponents;
}

std::vector<SurfaceSums> Surveyor::SurveyMesh() const {
    std::vector<SurfaceSums> ofComponents(static_cast<size_t>(_components.count));
    auto const curvature = eval::MeasureMeshCurvature(_level, _model.GetPositions(), _orientation);
    for (Index vertex = 0; vertex < _level.GetNumVertices(); ++vertex) {
        if (!(curvature.areas[vertex] > 0.0)) continue;
        SurfaceSums& sums = ofComponents[_components.ofFace[_level.GetVertexFaces(vertex)[0]]];
        sums.AddCurvature(curvature.areas[vertex], curvature.k1[vertex], curvature.k2[vertex]);
    }
    auto const faceNormals = eval::FindFaceNormals(_level, _model.GetPositions());
    far_ext::Points const points(_model.GetPositions()), normals(faceNormals);
    for (Index face = 0; face < _level.GetNumFaces(); ++face) {
        auto const vertices = _level.GetFaceVertices(face);
        double heights = 0.0;
        for (Index vertex : vertices)
            heights += points[vertex].dot(normals[face]) / vertices.size();
        ofComponents[_components.ofFace[face]].volume += GetSign(_orientation) * heights / 3.0;
    }
    return ofComponents;
}

/// Per component why its integral of K is not to be compared with 2 pi chi; empty where it is.
std::vector<std::string> Surveyor::FindReasons(MeasuredSurface surface) const {
    std::vector<std::string> reasons(static_cast<size_t>(_components.count));
    bool const isLimit = surface == MeasuredSurface::Limit;
    for (Index face = 0; face < _level.GetNumFaces(); ++face) {
        std::string& reason = reasons[_components.ofFace[face]];
        if (!reason.empty()) continue;
        if (isLimit && _model.GetCage().scheme == Sdc::SCHEME_BILINEAR)
            reason = "a bilinear surface has a crease along every edge";
        if (isLimit && _level.IsFaceHole(face)) reason = "it has a hole";
        for (Index edge : _level.GetFaceEdges(face)) {
            if (_level.GetEdgeFaces(edge).size() != 2)
                reason = "it is not closed";
            else if (isLimit && _level.IsEdgeInfSharp(edge))
                reason = "it has infinitely sharp creases";
        }
        for (Index vertex : _level.GetFaceVertices(face)) {
            if (isLimit && reason.empty() && _level.IsVertexInfSharp(vertex))
                reason = "it has infinitely sharp corners";
        }
    }
    return reasons;
}

/// Closed, manifold and wound one way: OpenSubdiv calls an edge that both its faces pass the same
/// way not manifold, too.
bool Surveyor::EnclosesVolume() const {
    if (!_model.GetCage().holes.empty()) return false;
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        if (_level.IsEdgeBoundary(edge) || _level.IsEdgeNonManifold(edge)) return false;
    }
    return true;
}

Measurement Surveyor::Conclude(std::vector<SurfaceSums> const& ofComponents,
                               MeasuredSurface surface) const {
    Measurement result;
    auto const reasons = FindReasons(surface);
    auto const euler = _components.FindEulerCharacteristics(_level);
    SurfaceSums all;
    for (size_t c = 0; c < static_cast<size_t>(_components.count); ++c) {
        SurfaceSums const& sums = ofComponents[c];
        all.Add(sums);
        GaussBonnetAudit audit;
        audit.component = static_cast<int>(c);
        audit.integral = sums.gaussian;
        audit.expected = 2.0 * kPi * euler[c];
        audit.relativeError =
            std::abs(audit.integral - audit.expected) / std::max(2.0 * kPi, sums.gaussianMagnitude);
        audit.reason = reasons[c];
        audit.wasAudited = audit.reason.empty();
        result.gaussBonnet.push_back(std::move(audit));
        result.eulerCharacteristic += euler[c];
    }
    if (EnclosesVolume()) result.volume = all.volume;
    result.area = all.area;
    if (surface == MeasuredSurface::Mesh) {  // boundary vertices have area, too
        auto const normals = eval::FindFaceNormals(_level, _model.GetPositions());
        result.area = 0.0;
        for (size_t i = 0; i < normals.size(); i += 3)
            result.area += std::hypot(normals[i], normals[i + 1], normals[i + 2]);
    }
    result.energy = {all.area > 0.0 ? all.bending / all.area : 0.0, all.bending};
    result.mean = MakeStatistics(all, all.mean, all.meanSquares, all.minMean, all.maxMean);
    result.gaussian =
        MakeStatistics(all, all.gaussian, all.gaussianSquares, all.minGaussian, all.maxGaussian);
    result.numSamples = all.count;
    return result;
}

/// k1 and k2 of every vertex, exact ones of the limit.
std::array<std::vector<double>, 2> FindLimitCurvature(Model const& model, Orientation orientation,
                                                      Job& job) {
    eval::LimitSurface const surface(model.GetRefiner());
    eval::FaceTree tree(surface, model.GetPositions(), 3);
    std::vector<char> isDone(static_cast<size_t>(model.GetCage().numVertices), 0);
    std::vector<double> const zeros(isDone.size(), 0.0);
    std::array<std::vector<double>, 2> curvatures{zeros, zeros};
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        job.CheckStopped();
        tree.Bind(face);
        auto const vertices = model.GetLevel().GetFaceVertices(face);
        for (int corner = 0; corner < vertices.size(); ++corner) {
            if (isDone[vertices[corner]]++) continue;
            auto const place = eval::GetCornerPlace(surface, face, corner);
            auto const x = eval::EvaluateSample(tree, place.domain, place.s, place.t, orientation);
            curvatures[0][vertices[corner]] = x.curvature.k1;
            curvatures[1][vertices[corner]] = x.curvature.k2;
        }
    }
    return curvatures;
}

}  // namespace

Measurement Measure(Model const& model, MeasuredSurface surface, Orientation orientation,
                    Job& job) {
    bool const isLimit = surface == MeasuredSurface::Limit;
    if (isLimit) RequireLimit(model);
    job.Start("measuring");
    Surveyor const surveyor(model, orientation, job);
    Measurement found =
        surveyor.Conclude(isLimit ? surveyor.SurveyLimit() : surveyor.SurveyMesh(), surface);
    if (found.volume.value_or(0.0) < 0.0) {
        Orientation const other =
            orientation == Orientation::Right ? Orientation::Left : Orientation::Right;
        job.Warn(
            fmt::format("{}: the volume is negative: the surface is seen inside out; "
                        "`orientation` {} turns it",
                        model.GetPath(), kOrientationWords.GetWord(other)));
    }
    return found;
}

VertexCurvature FindVertexCurvature(Model const& model, MeasuredSurface surface,
                                    Orientation orientation, Job& job) {
    job.Start("finding curvature at vertices");
    VertexCurvature found;
    if (surface == MeasuredSurface::Limit) {
        RequireLimit(model);
        auto k = FindLimitCurvature(model, orientation, job);
        found.k1 = std::move(k[0]);
        found.k2 = std::move(k[1]);
    } else {
        auto ofMesh =
            eval::MeasureMeshCurvature(model.GetLevel(), model.GetPositions(), orientation);
        found.k1 = std::move(ofMesh.k1);
        found.k2 = std::move(ofMesh.k2);
    }
    for (size_t v = 0; v < found.k1.size(); ++v) {
        found.mean.push_back(0.5 * (found.k1[v] + found.k2[v]));
        found.gaussian.push_back(found.k1[v] * found.k2[v]);
    }
    return found;
}

Scene AddVertexCurvature(Model const& model, VertexCurvature const& curvature) {
    Scene result = model.MakeScene();
    auto const add = [&](char const* name, std::vector<double> const& values) {
        auto& primvar = result.primvars.emplace_back(Primvar{name, 1, {}});
        std::transform(values.begin(), values.end(), std::back_inserter(primvar.values),
                       [](double x) { return static_cast<float>(x); });
    };
    add("mean", curvature.mean);
    add("gaussian", curvature.gaussian);
    add("k1", curvature.k1);
    add("k2", curvature.k2);
    return result;
}

}  // namespace limn::engine
