// SPDX-License-Identifier: Apache-2.0
#include "engine/field/control_form.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "engine/field/boundary_data.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"

namespace limn::engine {

namespace {

using Form = std::vector<double>;

void AddTo(Form& sum, Form const& part, double factor = 1.0) {
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += factor * part[i];
}

double FindLargest(Form const& values) {
    double largest = 0.0;
    for (double value : values) largest = std::max(largest, std::abs(value));
    return largest;
}

/// \param what  "a vortex: face", of each strength
Form Spread(Model const& model, std::vector<FieldStrength> const& strengths, Index count,
            char const* what) {
    Form values(static_cast<size_t>(count), 0.0);
    for (FieldStrength const& strength : strengths) {
        if (strength.element < 0 || strength.element >= count) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: {} {} does not exist; there are 0 to {}", model.GetPath(),
                                    what, strength.element, count - 1));
        }
        values[strength.element] += strength.strength;
    }
    return values;
}

/// Refuses or balances strengths that have nowhere to go.
///
/// \param componentOf  of each element; -1 where it has no faces
void Balance(Model const& model, std::vector<eval::FieldDesigner::Imbalance> const& imbalances,
             std::vector<int> const& componentOf, std::vector<int> const& componentOfFace,
             char const* what, bool isBalanced, Form& values) {
    for (auto const& imbalance : imbalances) {
        if (!isBalanced) {
            auto const face =
                std::find(componentOfFace.begin(), componentOfFace.end(), imbalance.component) -
                componentOfFace.begin();
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("{}: the {} on the component of face {} add up to {:.6g}, not "
                            "0, and nothing can leave it; change "
                            "them, or let `isBalanced` spread the opposite over the component",
                            model.GetPath(), what, face, imbalance.sum));
        }
        double const count = static_cast<double>(
            std::count(componentOf.begin(), componentOf.end(), imbalance.component));
        for (size_t i = 0; i < values.size(); ++i) {
            if (componentOf[i] == imbalance.component) values[i] -= imbalance.sum / count;
        }
    }
}

/// Refuses sources at vertices without faces.
void RequireFaces(Model const& model, std::vector<FieldStrength> const& sources,
                  std::vector<int> const& componentOf) {
    for (FieldStrength const& source : sources) {
        if (componentOf[source.element] < 0)
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: a source or sink: vertex {} has no faces, so that no "
                                    "field can flow there",
                                    model.GetPath(), source.element));
    }
}

void RefuseSingularity(Model const& model, eval::WantedIndex const& at, std::string const& why) {
    throw Error(ErrorCode::BadMesh, fmt::format("{}: a singularity of index {} at vertex {}: {}",
                                                model.GetPath(), at.index, at.vertex, why));
}

/// Refuses indices that no form has, or that do not add up to what a closed component has.
void RequireIndices(Model const& model, std::vector<eval::WantedIndex> const& wanted) {
    auto const level = model.GetLevel();
    auto const components = far_ext::FaceComponents::Find(level);
    std::vector<char> isTaken(level.GetNumVertices(), 0), isOpen(components.count, 0);
    std::vector<int> sums(components.count, 0), numWanted(components.count, 0);
    for (auto const& at : wanted) {
        auto const refuse = [&](std::string const& why) { RefuseSingularity(model, at, why); };
        if (at.vertex < 0 || at.vertex >= level.GetNumVertices())
            refuse(fmt::format("there are vertices 0 to {}", level.GetNumVertices() - 1));
        if (level.GetVertexFaces(at.vertex).size() == 0) refuse("the vertex has no faces");
        if (level.IsVertexBoundary(at.vertex)) refuse("the vertex is on a boundary");
        if (isTaken[at.vertex]) refuse("the vertex has another one already");
        if (at.index > 1)
            refuse("the signs of a form give 1 at most; place several of index 1 side by side");
        int const valence = level.GetVertexEdges(at.vertex).size();
        if (valence < 2 * (1 - at.index))
            refuse(
                fmt::format("the vertex has {} edges; it takes {}", valence, 2 * (1 - at.index)));
        isTaken[at.vertex] = 1;
        int const component = components.ofFace[level.GetVertexFaces(at.vertex)[0]];
        sums[component] += at.index;
        ++numWanted[component];
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const faces = level.GetEdgeFaces(edge);
        if (faces.size() == 1) isOpen[components.ofFace[faces[0]]] = 1;
    }
    auto const euler = components.FindEulerCharacteristics(level);
    for (int c = 0; c < components.count; ++c) {
        if (isOpen[c] || numWanted[c] == 0 || sums[c] == euler[c]) continue;
        auto const face = std::ranges::find(components.ofFace, c) - components.ofFace.begin();
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the singularities on the component of face {} add up to {}, "
                                "not to its Euler characteristic {}",
                                model.GetPath(), face, sums[c], euler[c]));
    }
}

/// \param what  of each element: "vertices"
void RequireCount(Model const& model, std::optional<Form> const& values, Index count,
                  char const* what) {
    if (!values || values->size() == static_cast<size_t>(count)) return;
    throw Error(ErrorCode::BadMesh, fmt::format("{}: {} values; the mesh has {} {}",
                                                model.GetPath(), values->size(), count, what));
}

bool HasBoundaryData(FieldOptions const& options) {
    return !options.loops.empty() || !options.boundaryEdges.empty() || !options.arcFluxes.empty();
}

/// Adds up the parts of a field.
class ControlFormMaker {
public:
    ControlFormMaker(Model const& model, FieldOptions const& options, Job& job)
        : _model(model),
          _options(options),
          _job(job),
          _level(model.GetLevel()),
          _designer(_level, model.GetPositions(), options.atBoundary) {
        auto const numEdges = static_cast<size_t>(_level.GetNumEdges());
        _made.form.assign(numEdges, 0.0);
        if (options.edges && options.edges->size() != numEdges) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: {} values along edges; the mesh has {} edges",
                                    model.GetPath(), options.edges->size(), numEdges));
        }
        RequireCount(model, options.values, _level.GetNumVertices(), "vertices");
        RequireCount(model, options.integrals, _level.GetNumFaces(), "faces");
        RequireIndices(model, options.singularities);
    }

    ControlForm Make() {
        auto const start = std::chrono::steady_clock::now();
        AddFlow();
        _job.CheckStopped();
        AddHarmonics();
        if (_options.edges) AddTo(_made.form, *_options.edges);
        if (!_options.singularities.empty())
            AddTo(_made.form,
                  eval::MakeUnitField(_level, _model.GetPositions(), _options.singularities));
        if (!_options.wanted.empty())
            AddTo(_made.form, eval::MatchVectors(_model.GetRefiner(), _model.GetPositions(),
                                                 _options.wanted, [&] { _job.CheckStopped(); }));
        if (_options.texture) AddTo(_made.form, MatchFieldTexture(_model, *_options.texture, _job));
        _job.CheckStopped();
        AddFunctions();
        Audit();
        _made.audit.solveSeconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return std::move(_made);
    }

private:
    /// What comes of sources and vortices.
    void AddFlow() {
        auto const& ofFace = _designer.GetComponents().ofFace;
        auto const& ofVertex = _designer.GetComponentOfVertex();
        Form sources =
            Spread(_model, _options.sources, _level.GetNumVertices(), "a source or sink: vertex");
        Form vortices = Spread(_model, _options.vortices, _level.GetNumFaces(), "a vortex: face");
        if (_options.integrals) AddTo(vortices, *_options.integrals);
        RequireFaces(_model, _options.sources, ofVertex);
        if (HasBoundaryData(_options)) {
            auto bounded = DesignBounded(_model, _options, std::move(sources), std::move(vortices));
            _made.audit.boundary = std::move(bounded.audit);
            AddTo(_made.form, bounded.form);
            return;
        }
        Balance(_model, _designer.FindSourceImbalance(sources), ofVertex, ofFace,
                "sources and sinks", _options.isBalanced, sources);
        Balance(_model, _designer.FindVortexImbalance(vortices), ofFace, ofFace, "vortices",
                _options.isBalanced, vortices);
        if (!_options.sources.empty()) AddTo(_made.form, _designer.MakeGradient(sources));
        if (!_options.vortices.empty() || _options.integrals)
            AddTo(_made.form, _designer.MakeVortex(vortices));
    }

    void AddHarmonics() {
        _made.audit.numGenerators = _designer.CountHarmonics();
        if (!_options.harmonics) return;
        if (static_cast<int>(_options.harmonics->size()) != _made.audit.numGenerators) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("{}: `harmonics` gives {} coefficients; the surface has {} generators",
                            _model.GetPath(), _options.harmonics->size(),
                            _made.audit.numGenerators));
        }
        auto const& harmonics = _designer.GetHarmonics();
        for (size_t i = 0; i < harmonics.size(); ++i)
            AddTo(_made.form, harmonics[i], (*_options.harmonics)[i]);
    }

    /// Functions given as such, and that of which the rest has the gradient.
    void AddFunctions() {
        auto inflow = _designer.FindInflow(_made.form);
        for (double& value : inflow) value = -value;
        _made.values = _designer.FindPotential(inflow);
        Form given(_made.values.size(), 0.0);
        if (_options.values) AddTo(given, *_options.values);
        if (!_options.pins.empty()) AddTo(given, MakePinned());
        if (!_options.values && _options.pins.empty()) return;
        AddTo(_made.values, given);
        AddTo(_made.form, far_ext::TakeDifferences(_level, given));
    }

    Form MakePinned() const {
        if (_options.pins.size() < 2) {
            throw Error(ErrorCode::BadOption,
                        "`pins`: one value alone makes a constant; a field takes two or more");
        }
        std::vector<char> isPinned(_level.GetNumVertices(), 0);
        for (eval::Pin const& pin : _options.pins) {
            bool const isThere = pin.vertex >= 0 && pin.vertex < _level.GetNumVertices();
            if (!isThere || isPinned[pin.vertex]) {
                throw Error(ErrorCode::BadMesh,
                            fmt::format("{}: `pins`: vertex {} {}", _model.GetPath(), pin.vertex,
                                        isThere ? "has a value already" : "does not exist"));
            }
            isPinned[pin.vertex] = 1;
        }
        return eval::MakeHarmonicFunction(_level, _designer.GetStars().edge, _options.pins);
    }

    void Audit() {
        FieldAudit& audit = _made.audit;
        auto const parts = _designer.Decompose(_made.form);
        audit.gradientNorm = _designer.FindNorm(parts.gradient);
        audit.vortexNorm = _designer.FindNorm(parts.vortex);
        audit.harmonicNorm = _designer.FindNorm(parts.harmonic);
        auto const relative = [&](Form const& law, Form const& part) {
            double const size = FindLargest(part);
            return size > 1e-12 * FindLargest(_made.form) ? FindLargest(law) / size : 0.0;
        };
        audit.maxCurlOfGradient = relative(_designer.FindCurl(parts.gradient), parts.gradient);
        audit.maxDivergenceOfVortex = relative(_designer.FindInflow(parts.vortex), parts.vortex);
    }

    Model const& _model;
    FieldOptions const& _options;
    Job& _job;
    Far::TopologyLevel const& _level;
    eval::FieldDesigner _designer;
    ControlForm _made;
};

}  // namespace

ControlForm DesignControlForm(Model const& model, FieldOptions const& options, Job& job) {
    return ControlFormMaker(model, options, job).Make();
}

}  // namespace limn::engine
