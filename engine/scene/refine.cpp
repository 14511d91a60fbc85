// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/refine.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/scene_checks.h"
#include "eval/differential/value_refiner.h"
#include "eval/fit/alpha_steps.h"
#include "eval/fit/limit_application.h"
#include "eval/surface/vertex_limits.h"
#include "far_ext/error.h"
#include "far_ext/topology/refined_cage.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;
using far_ext::SubdivisionRule;

std::vector<double> RefineUVs(eval::ValueRefiner& refiner, std::vector<double> values, Job& job) {
    for (int level = 1; level <= refiner.GetRefiner().GetMaxLevel(); ++level) {
        job.CheckStopped();
        values = refiner.RefineFVar<2>(level, values, 0);
    }
    return values;
}

/// A number per vertex through all levels.
///
/// \param alpha  none: the plain rule
std::vector<double> RefineNumbers(eval::ValueRefiner& refiner, std::vector<double> values,
                                  eval::AlphaSteps const* alpha, Job& job) {
    for (int level = 1; level <= refiner.GetRefiner().GetMaxLevel(); ++level) {
        job.CheckStopped();
        auto fine = refiner.Refine<1>(level, values);
        if (alpha) alpha->Add(level - 1, values, 1, fine);
        values = std::move(fine);
    }
    return values;
}

Primvar RefinePrimvar(eval::ValueRefiner& refiner, Primvar const& primvar,
                      eval::AlphaSteps const* alpha, Job& job) {
    Primvar fine{primvar.name, primvar.numChannels, {}};
    size_t const n = static_cast<size_t>(primvar.numChannels);
    for (size_t c = 0; c < n; ++c) {
        std::vector<double> channel;
        for (size_t i = c; i < primvar.values.size(); i += n)
            channel.push_back(static_cast<double>(primvar.values[i]));
        auto const refined = RefineNumbers(refiner, std::move(channel), alpha, job);
        fine.values.resize(refined.size() * n);
        for (size_t i = 0; i < refined.size(); ++i)
            fine.values[i * n + c] = static_cast<float>(refined[i]);
    }
    return fine;
}

/// Whether second eigenvalues of a rule, on triangles, leave no room for a tangent plane at an
/// inner vertex of this valence: complex at 3 but for the original Butterfly's, which meet others
/// there and from 8 on.
bool IsRoughAt(int valence, far_ext::SubdivisionRule rule) {
    if (valence == 3) return true;
    return rule == far_ext::SubdivisionRule::OriginalButterfly && valence >= 8;
}

/// "vertices 3, 5, 8 and 12 more"
std::string ListVertices(std::vector<Index> const& vertices) {
    constexpr size_t kMostListed = 8;
    std::span const listed = std::span(vertices).first(std::min(kMostListed, vertices.size()));
    std::string list =
        fmt::format("{} {}", vertices.size() == 1 ? "vertex" : "vertices", fmt::join(listed, ", "));
    if (listed.size() < vertices.size())
        list += fmt::format(" and {} more", vertices.size() - listed.size());
    return list;
}

/// None where alpha is 0.
std::unique_ptr<eval::AlphaSteps> MakeAlphaSteps(Far::TopologyRefiner const& refiner,
                                                 RefineOptions const& options) {
    if (options.alpha == 0.0) return nullptr;
    if (options.rule.rule != SubdivisionRule::Scheme)
        throw Error(ErrorCode::BadOption, "alpha is a parameter of the catmark rule alone");
    int const lastLevel = options.toLimit ? options.levels : options.levels - 1;
    return std::make_unique<eval::AlphaSteps>(refiner, lastLevel, options.alpha);
}

/// Vertices of the refiner's last level at their limit. Those without a face that has one stay.
///
/// \param evaluator  null: without a limit matrix, in double
std::vector<double> MoveToLimit(Far::TopologyRefiner const& refiner, Scene const& fine,
                                eval::TableEvaluator* evaluator, Job& job) {
    job.Start("moving vertices to the limit");
    if (evaluator) {
        auto const ofFine = far_ext::CreateRefiner(fine.cage);
        std::vector<double> limits(fine.positions.size());
        NamingMesh(fine.path, [&] {
            return eval::LimitApplication::Build(*ofFine, {}, evaluator);
        }).Apply(fine.positions, 3, limits);
        return limits;
    }
    NamingMesh(fine.path, [&] { eval::LimitSurface::CheckExcess(refiner, refiner.GetMaxLevel()); });
    return eval::FindVertexLimits(refiner, refiner.GetMaxLevel(), fine.positions, 3,
                                  [&] { job.CheckStopped(); })
        .values;
}

}  // namespace

std::unique_ptr<Far::TopologyRefiner> MakeUniformRefiner(far_ext::ControlMesh const& cage,
                                                         std::string const& path, int levels) {
    if (levels < 0 || levels > 10) {
        throw Error(ErrorCode::BadOption, fmt::format("`levels`: {} is not from 0 to 10", levels));
    }
    double const corners = static_cast<double>(cage.faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9) {
        throw Error(ErrorCode::TooLarge,
                    fmt::format("{}: {} levels would make {:.1e} face corners; at most 2e9 can be "
                                "indexed",
                                path, levels, corners));
    }
    auto refiner = far_ext::CreateRefiner(cage);
    Far::TopologyRefiner::UniformOptions uniform(levels);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

void WarnOfRoughVertices(Model const& model, far_ext::TunedRule const& rule, Job& job) {
    using far_ext::SubdivisionRule;
    bool const isOriginal = rule.rule == SubdivisionRule::OriginalButterfly;
    bool const isOfLoop =
        rule.rule == SubdivisionRule::Interpolating && model.GetCage().scheme == Sdc::SCHEME_LOOP;
    if (!isOriginal && !isOfLoop) return;
    Level const& level = model.GetLevel();
    std::vector<Index> rough;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (!level.IsVertexBoundary(vertex) &&
            IsRoughAt(level.GetVertexEdges(vertex).size(), rule.rule))
            rough.push_back(vertex);
    }
    if (rough.empty()) return;
    job.Warn(fmt::format("{}: this `rule` is not smooth at valence {}: {}; butterfly and loop are",
                         model.GetPath(), isOriginal ? "3 and from 8 on" : "3",
                         ListVertices(rough)));
}

void InheritFromFaces(Model const& model, std::vector<Index> const& baseFaces, Scene& fine) {
    for (size_t kind = 0; kind < fine.groups.size(); ++kind) {
        FaceGroups const& groups = model.GetGroups()[kind];
        fine.groups[kind].names = groups.names;
        if (groups.faceGroup.empty()) continue;
        for (Index face : baseFaces) fine.groups[kind].faceGroup.push_back(groups.faceGroup[face]);
    }
    auto const& lacksUVs = model.GetFacesLackingUVs();
    for (Index face : baseFaces) {
        if (!lacksUVs.empty()) fine.lacksUVs.push_back(lacksUVs[face]);
    }
}

Scene RefineAllButPositions(Model const& model, eval::ValueRefiner& values, Job& job,
                            eval::AlphaSteps const* alpha) {
    Far::TopologyRefiner const& refiner = values.GetRefiner();
    job.Start("refining attributes");
    Scene fine;
    fine.path = model.GetPath();
    fine.name = model.GetName();
    fine.cage = far_ext::MakeRefinedCage(refiner, model.GetCage());
    if (model.HasUVs()) fine.uvs = RefineUVs(values, model.GetUVs(), job);
    for (Primvar const& primvar : model.GetPrimvars())
        fine.primvars.push_back(RefinePrimvar(values, primvar, alpha, job));
    InheritFromFaces(model, far_ext::FindBaseFaces(refiner, refiner.GetMaxLevel()), fine);
    return fine;
}

Scene RefineUniformly(Model const& model, RefineOptions const& options, Job& job) {
    far_ext::CheckTension(options.rule);
    WarnOfRoughVertices(model, options.rule, job);
    job.Start("refining topology");
    std::unique_ptr<Far::TopologyRefiner> const refined =
        options.levels == 0 ? nullptr
                            : MakeUniformRefiner(model.GetCage(), model.GetPath(), options.levels);
    Far::TopologyRefiner const& refiner = refined ? *refined : model.GetRefiner();
    auto const alpha = MakeAlphaSteps(refiner, options);
    eval::ValueRefiner values(refiner, options.evaluator);
    Scene fine = RefineAllButPositions(model, values, job, alpha.get());
    job.Start("refining positions");
    fine.positions = model.GetPositions();
    for (int level = 1; level <= options.levels; ++level) {
        job.CheckStopped();
        auto children = values.Refine<3>(level, fine.positions, options.rule);
        if (alpha) alpha->Add(level - 1, fine.positions, 3, children);
        fine.positions = std::move(children);
    }
    if (!options.toLimit) return fine;
    if (alpha)
        fine.positions = alpha->FindLimits(fine.positions, 3);
    else if (!options.rule.IsInterpolating())
        fine.positions = MoveToLimit(refiner, fine, options.evaluator, job);
    return fine;
}

}  // namespace limn::engine
