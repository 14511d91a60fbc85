// SPDX-License-Identifier: Apache-2.0
#include "eval/streamlines/flow_surface.h"

#include <cmath>

#include <Eigen/Geometry>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "eval/streamlines/face_sides.h"

namespace limn::eval {

namespace {

/// Refinements that make the field near irregular vertices good: some 5e4 faces.
int ChooseDetail(Index numFaces) {
    constexpr double kFaces = 5e4;
    constexpr int kMost = 4;
    int levels = 1;
    for (double count = 4.0 * numFaces; levels < kMost && 4.0 * count <= kFaces; count *= 4.0)
        ++levels;
    return levels;
}

}  // namespace

FlowSurface::FlowSurface(far_ext::ControlMesh const& cage, std::span<double const> positions,
                         std::span<double const> form, TableEvaluator* evaluator)
    : _faces(cage, positions, form, 0, evaluator),
      _near(_faces.GetRefinedCage(), _faces.GetPositions(), _faces.GetForm(),
            ChooseDetail(_faces.GetSurface().GetNumFaces()), evaluator) {}

void FlowSurface::Sampler::Bind(Index face) {
    if (face != _face) _faces.Bind(face);
    _face = face;
}

FieldSurface::Here FlowSurface::Sampler::Evaluate(double s, double t) {
    if (_faces.IsRegular()) return _faces.EvaluateHere(s, t);
    auto const [nearS, nearT] = FaceSides(_isLoop).Clamp({s, t});
    auto here = _faces.EvaluateHere(nearS, nearT);
    _near.Evaluate(_face, 0, {&nearS, 1}, {&nearT, 1}, {&here.vector, 1});
    return here;
}

std::vector<double> FlowSurface::FindSpeeds() const {
    auto const& level = GetLevel();
    auto const& surface = GetSurface();
    std::vector<double> speeds(level.GetNumVertices(), 0.0);
    tbb::enumerable_thread_specific<Sampler> samplers([&] { return Sampler(*this); });
    tbb::parallel_for(
        tbb::blocked_range<Index>(0, level.GetNumVertices(), 256), [&](auto const& vertices) {
            Sampler& sampler = samplers.local();
            for (Index vertex = vertices.begin(); vertex != vertices.end(); ++vertex) {
                auto const faces = level.GetVertexFaces(vertex);
                int i = 0;
                while (i < faces.size() && !surface.HasLimit(faces[i])) ++i;
                if (i == faces.size()) continue;
                auto const place =
                    GetCornerPlace(surface, faces[i], level.GetVertexFaceLocalIndices(vertex)[i]);
                sampler.Bind(place.face);
                speeds[vertex] = sampler.Evaluate(place.s, place.t).vector.norm();
            }
        });
    return speeds;
}

double FlowSurface::FindRmsSpeed() const {
    double sum = 0.0;
    auto const speeds = FindSpeeds();
    for (double const speed : speeds) sum += speed * speed;
    return speeds.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(speeds.size()));
}

std::optional<Velocity> FindVelocity(FieldSurface::Here const& here, Heading heading,
                                     double leastSpeed) {
    double const speed = here.vector.norm();
    Eigen::Vector3d const normal = here.ds.cross(here.dt);
    double const area2 = normal.squaredNorm();
    if (!(speed > leastSpeed) || !(area2 > 0.0)) return {};
    Eigen::Vector3d direction = here.vector / speed;
    if (heading == Heading::Left || heading == Heading::Right)
        direction = normal.cross(direction) / std::sqrt(area2);
    if (heading == Heading::Backward || heading == Heading::Right) direction = -direction;
    // direction = s ds + t dt, by Cramer's rule in the tangent plane.
    return Velocity{direction.cross(here.dt).dot(normal) / area2,
                    here.ds.cross(direction).dot(normal) / area2, direction};
}

}  // namespace limn::eval
