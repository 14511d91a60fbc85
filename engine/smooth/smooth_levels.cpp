// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/smooth_levels.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/scene/refine.h"
#include "engine/scene/scene_checks.h"
#include "eval/differential/value_refiner.h"
#include "far_ext/error.h"
#include "far_ext/topology/refined_cage.h"

namespace limn::engine {

namespace {

/// Appends the means of pairs of values.
template <class Value>
void AppendMeans(std::vector<Value>& values, size_t numChannels,
                 std::span<std::array<Index, 2> const> parents) {
    for (auto const& [a, b] : parents) {
        for (size_t c = 0; c < numChannels; ++c) {
            values.push_back((values[static_cast<size_t>(a) * numChannels + c] +
                              values[static_cast<size_t>(b) * numChannels + c]) /
                             2);
        }
    }
}

far_ext::Bisection StartBisection(Model const& model, bool keepsCreases) {
    auto const& cage = model.GetCage();
    for (Index face = 0; face < cage.GetNumFaces(); ++face) {
        if (cage.faceSizes[face] == 3) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: {} has {} corners; `refinement` bisect needs triangles, "
                                "quadrisect takes all polygons",
                                model.GetPath(), model.NameFace(face), cage.faceSizes[face]));
    }
    auto const isInfinite = [](float sharpness) {
        return sharpness >= far_ext::kInfiniteSharpness;
    };
    std::vector<std::array<Index, 2>> creases;
    std::vector<Index> corners;
    for (size_t i = 0; keepsCreases && i < cage.creaseSharpness.size(); ++i) {
        if (isInfinite(cage.creaseSharpness[i]))
            creases.push_back({cage.creaseVertexPairs[2 * i], cage.creaseVertexPairs[2 * i + 1]});
    }
    for (size_t i = 0; keepsCreases && i < cage.cornerSharpness.size(); ++i) {
        if (isInfinite(cage.cornerSharpness[i])) corners.push_back(cage.cornerVertices[i]);
    }
    far_ext::Bisection bisection(cage.numVertices, cage.faceVertices, model.GetPositions(),
                                 std::move(creases), std::move(corners));
    if (model.HasUVs())
        bisection.SetFVarChannel(cage.fvarChannels[0].numValues, cage.fvarChannels[0].valueIndices);
    return bisection;
}

}  // namespace

Sdc::SchemeType ChooseCascadeScheme(far_ext::ControlMesh const& cage) {
    bool const areTriangles = std::all_of(cage.faceSizes.begin(), cage.faceSizes.end(),
                                          [](int size) { return size == 3; });
    return areTriangles ? Sdc::SCHEME_LOOP : cage.scheme;
}

SmoothLevels::SmoothLevels(Model const& model, int numLevels, SmoothRefinement refinement,
                           bool keepsCreases)
    : _model(model),
      _keepsCreases(keepsCreases),
      _uvs(model.GetUVs()),
      _primvars(model.GetPrimvars()) {
    if (refinement == SmoothRefinement::Bisect && numLevels > 0) {
        _bisection = StartBisection(model, keepsCreases);
        _mesh = _bisection->GetMesh();
    } else {
        _refiner = MakeUniformRefiner(model.GetCage(), model.GetPath(), numLevels);
    }
}

void SmoothLevels::DropTags() {
    if (_keepsCreases) return;
    _mesh.creases.clear();
    _mesh.corners.clear();
}

far_ext::CascadeMesh const& SmoothLevels::MakeUnrefined() {
    _mesh = NamingMesh(_model.GetPath(), [&] { return far_ext::MakeCascadeMesh(*_refiner, 0); });
    DropTags();
    return _mesh;
}

far_ext::CascadeMesh const& SmoothLevels::MakeNext() {
    ++_level;
    if (_bisection) return TakeBisected(_bisection->Refine());
    _mesh = far_ext::MakeCascadeMesh(*_refiner, _level);
    DropTags();
    return _mesh;
}

far_ext::CascadeMesh const& SmoothLevels::MakeNext(std::span<char const> isMarked) {
    ++_level;
    return TakeBisected(_bisection->Refine(isMarked));
}

/// Carries primvars and texture coordinates along.
far_ext::CascadeMesh const& SmoothLevels::TakeBisected(far_ext::CascadeMesh const& fine) {
    Index const numCoarse = _mesh.numVertices;
    _mesh = fine;
    std::vector<std::array<Index, 2>> parents;
    for (Index vertex = numCoarse; vertex < _mesh.numVertices; ++vertex) {
        Index const* const own = &_mesh.parents[static_cast<size_t>(_mesh.parentOffsets[vertex])];
        parents.push_back({own[0], own[1]});
    }
    for (Primvar& primvar : _primvars)
        AppendMeans(primvar.values, static_cast<size_t>(primvar.numChannels), parents);
    AppendMeans(_uvs, 2, _bisection->GetFVarParents());
    return _mesh;
}

std::vector<Index> SmoothLevels::FindBaseFaces() const {
    if (_bisection) return _bisection->GetBaseFaces();
    return far_ext::FindBaseFaces(*_refiner, _level);
}

std::vector<double> SmoothLevels::FindCornerUVs() {
    std::vector<double> corners;
    corners.reserve(2 * _mesh.faces.size());
    auto const add = [&](Index value) {
        corners.insert(corners.end(), {_uvs[2 * static_cast<size_t>(value)],
                                       _uvs[2 * static_cast<size_t>(value) + 1]});
    };
    if (_bisection) {
        std::for_each(_bisection->GetFVarValues().begin(), _bisection->GetFVarValues().end(), add);
        return corners;
    }
    while (_uvLevel < _level) _uvs = eval::RefineValues<2>(*_refiner, ++_uvLevel, _uvs, 0);
    auto const level = _refiner->GetLevel(_level);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const values = level.GetFaceFVarValues(face, 0);
        std::for_each(values.begin(), values.end(), add);
    }
    return corners;
}

Scene SmoothLevels::MakeQuarteredScene(Job& job) const {
    eval::ValueRefiner values(*_refiner, nullptr);
    return RefineAllButPositions(_model, values, job);
}

Scene SmoothLevels::MakeScene(Job& job) const {
    Scene fine = _bisection ? MakeBisectedScene() : MakeQuarteredScene(job);
    if (!_keepsCreases) {
        fine.cage.creaseVertexPairs.clear();
        fine.cage.creaseSharpness.clear();
        fine.cage.cornerVertices.clear();
        fine.cage.cornerSharpness.clear();
    }
    return fine;
}

Scene SmoothLevels::MakeBisectedScene() const {
    Scene fine;
    fine.path = _model.GetPath();
    fine.name = _model.GetName();
    fine.cage.scheme = _model.GetCage().scheme;
    fine.cage.options = _model.GetCage().options;
    fine.cage.numVertices = _mesh.numVertices;
    fine.cage.faceVertices = _mesh.faces;
    fine.cage.faceSizes.assign(static_cast<size_t>(_mesh.GetNumFaces()), 3);
    for (auto const& crease : _mesh.creases) {
        fine.cage.creaseVertexPairs.insert(fine.cage.creaseVertexPairs.end(), crease.begin(),
                                           crease.end());
        fine.cage.creaseSharpness.push_back(far_ext::kInfiniteSharpness);
    }
    fine.cage.cornerVertices = _mesh.corners;
    fine.cage.cornerSharpness.assign(_mesh.corners.size(), far_ext::kInfiniteSharpness);
    if (_model.HasUVs()) {
        fine.uvs = _uvs;
        fine.cage.fvarChannels.push_back(
            {static_cast<Index>(_uvs.size() / 2), _bisection->GetFVarValues()});
    }
    fine.primvars = _primvars;
    auto const& base = _bisection->GetBaseFaces();
    std::vector<char> isHole(_model.GetCage().faceSizes.size(), 0);
    for (Index hole : _model.GetCage().holes) isHole[hole] = 1;
    for (size_t face = 0; face < base.size(); ++face) {
        if (isHole[base[face]]) fine.cage.holes.push_back(static_cast<Index>(face));
    }
    InheritFromFaces(_model, base, fine);
    return fine;
}

}  // namespace limn::engine
