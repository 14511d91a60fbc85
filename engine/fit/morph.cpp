// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/morph.h"

#include <fmt/format.h>

#include "engine/scene/same_faces.h"
#include "eval/fit/decompose.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

std::string Describe(Model const& from, Model const& to, FaceDifference const& difference) {
    switch (difference.kind) {
        case FaceDifference::Kind::NumVertices:
            return fmt::format("{} and {} vertices", difference.a, difference.b);
        case FaceDifference::Kind::NumFaces:
            return fmt::format("{} and {} faces", difference.a, difference.b);
        default:
            return fmt::format("{} has other vertices than {}", from.NameFace(difference.face),
                               to.NameFace(difference.face));
    }
}

void RequireSameFaces(Model const& from, Model const& to) {
    auto const difference = FindFaceDifference(from.GetCage(), to.GetCage());
    if (!difference) return;
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("{} and {} do not have the same faces: {}; a morph needs the same vertices and "
                    "faces in the same order",
                    from.GetPath(), to.GetPath(), Describe(from, to, *difference)));
}

}  // namespace

Morph::Morph(Model const& from, Model const& to, MorphOptions const& options)
    : _to(to),
      _options(options),
      _operator(eval::LimitOperator::Build(to.GetRefiner(), 0, {.alpha = options.alpha})),
      _positions(from.GetPositions()) {
    RequireSameFaces(from, to);
}

std::vector<double> const& Morph::MakeNext(Job& job) {
    job.CheckStopped();
    job.Start("morphing");
    eval::MorphStep(_operator, 3, _options.detail, _options.rate, _to.GetPositions(), _positions);
    return _positions;
}

}  // namespace limn::engine
