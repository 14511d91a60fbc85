// SPDX-License-Identifier: Apache-2.0
#include "engine/field/field.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "engine/scene/refine.h"
#include "eval/differential/refine_values.h"
#include "eval/forms/vertex_covectors.h"
#include "far_ext/differential/subdivision_rows.h"
#include "far_ext/error.h"
#include "far_ext/forms/face_vectors.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/rows/points.h"

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

/// The form on the control mesh, and what an audit says of it.
struct Design {
    Form form;
    FieldAudit audit;
};

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

Design DesignControlForm(Model const& model, FieldOptions const& options, Job& job) {
    auto const& level = model.GetLevel();
    FieldAudit audit;
    auto const start = std::chrono::steady_clock::now();
    eval::FieldDesigner designer(level, model.GetPositions(), options.atBoundary);
    auto const& ofFace = designer.GetComponents().ofFace;
    auto const& ofVertex = designer.GetComponentOfVertex();
    Form sources =
        Spread(model, options.sources, level.GetNumVertices(), "a source or sink: vertex");
    Form vortices = Spread(model, options.vortices, level.GetNumFaces(), "a vortex: face");
    RequireFaces(model, options.sources, ofVertex);
    Balance(model, designer.FindSourceImbalance(sources), ofVertex, ofFace, "sources and sinks",
            options.isBalanced, sources);
    Balance(model, designer.FindVortexImbalance(vortices), ofFace, ofFace, "vortices",
            options.isBalanced, vortices);

    audit.numGenerators = designer.CountHarmonics();
    if (options.harmonics && static_cast<int>(options.harmonics->size()) != audit.numGenerators) {
        throw Error(
            ErrorCode::BadMesh,
            fmt::format("{}: `harmonics` gives {} coefficients; the surface has {} generators",
                        model.GetPath(), options.harmonics->size(), audit.numGenerators));
    }
    Form form(static_cast<size_t>(level.GetNumEdges()), 0.0);
    if (options.edges && options.edges->size() != form.size()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: {} values along edges; the mesh has {} edges", model.GetPath(),
                                options.edges->size(), form.size()));
    }
    if (!options.sources.empty()) AddTo(form, designer.MakeGradient(sources));
    if (!options.vortices.empty()) AddTo(form, designer.MakeVortex(vortices));
    job.CheckStopped();
    if (options.harmonics) {
        auto const& harmonics = designer.GetHarmonics();
        for (size_t i = 0; i < harmonics.size(); ++i)
            AddTo(form, harmonics[i], (*options.harmonics)[i]);
    }
    if (options.edges) AddTo(form, *options.edges);
    if (!options.wanted.empty())
        AddTo(form, eval::MatchVectors(model.GetRefiner(), model.GetPositions(), options.wanted,
                                       [&] { job.CheckStopped(); }));

    job.CheckStopped();
    auto const parts = designer.Decompose(form);
    audit.gradientNorm = designer.FindNorm(parts.gradient);
    audit.vortexNorm = designer.FindNorm(parts.vortex);
    audit.harmonicNorm = designer.FindNorm(parts.harmonic);
    auto const relative = [&](Form const& law, Form const& part) {
        double const size = FindLargest(part);
        return size > 1e-12 * FindLargest(form) ? FindLargest(law) / size : 0.0;
    };
    audit.maxCurlOfGradient = relative(designer.FindCurl(parts.gradient), parts.gradient);
    audit.maxDivergenceOfVortex = relative(designer.FindInflow(parts.vortex), parts.vortex);
    audit.solveSeconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {std::move(form), audit};
}

/// The largest entry of A B - C D over `numColumns` columns, row by row.
double FindLargestDifference(far_ext::SparseRows const& a, far_ext::SparseRows const& b,
                             far_ext::SparseRows const& c, far_ext::SparseRows const& d,
                             Index numColumns) {
    double largest = 0.0;
    Form row(static_cast<size_t>(numColumns), 0.0);  // 0 but for the columns touched
    std::vector<Index> touched;
    auto const add = [&](far_ext::SparseRows const& left, far_ext::SparseRows const& right,
                         int index, double sign) {
        for (int k = left.offsets[index]; k < left.offsets[index + 1]; ++k) {
            Index const inner = left.indices[k];
            for (int m = right.offsets[inner]; m < right.offsets[inner + 1]; ++m) {
                row[right.indices[m]] += sign * left.weights[k] * right.weights[m];
                touched.push_back(right.indices[m]);
            }
        }
    };
    for (int index = 0; index < a.GetNumRows(); ++index) {
        add(a, b, index, 1.0);
        add(c, d, index, -1.0);
        for (Index column : touched) {
            largest = std::max(largest, std::abs(row[column]));
            row[column] = 0.0;
        }
        touched.clear();
    }
    return largest;
}

/// Refines the form, and checks at each step that its stencils commute.
Form Subdivide(Far::TopologyRefiner const& refiner, Form form, FieldAudit& audit, Job& job) {
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        job.CheckStopped();
        auto const coarse = refiner.GetLevel(level - 1), fine = refiner.GetLevel(level);
        auto const step = far_ext::BuildFormStencils(refiner, level);
        auto const s0 =
            far_ext::BuildSubdivisionRows(refiner, level, far_ext::SubdivisionRule::Scheme);
        audit.commutationD0 =
            std::max(audit.commutationD0,
                     FindLargestDifference(far_ext::BuildD0(fine), s0, step.s1,
                                           far_ext::BuildD0(coarse), coarse.GetNumVertices()));
        audit.commutationD1 =
            std::max(audit.commutationD1,
                     FindLargestDifference(far_ext::BuildD1(fine), step.s1, step.s2,
                                           far_ext::BuildD1(coarse), coarse.GetNumEdges()));
        form = step.s1.Apply(form);
    }
    return form;
}

std::array<double, 3> ToArray(Eigen::Vector3d const& v) {
    return {v[0], v[1], v[2]};
}

void FindVertexVectors(Field& field) {
    int const last = field.refined->GetMaxLevel();
    Index const count = field.refined->GetLevel(last).GetNumVertices();
    field.vectors.resize(count);
    field.mesh.normals.resize(field.mesh.positions.size());
    far_ext::MutablePoints const normals(field.mesh.normals);
    eval::VertexCovectors const covectors(*field.refined, last);
    tbb::parallel_for(Index(0), count, [&](Index vertex) {
        auto const covector = covectors.Find(vertex, field.form, field.mesh.positions);
        field.vectors[vertex] = ToArray(covector.GetVector());
        normals[vertex] = covector.GetNormal();
    });
}

void FindFaceVectors(Field& field) {
    auto const level = field.refined->GetLevel(field.refined->GetMaxLevel());
    Form const values = far_ext::BuildFaceVectors(level, field.mesh.positions).Apply(field.form);
    for (size_t i = 0; i < values.size(); i += 3)
        field.faceVectors.push_back({values[i], values[i + 1], values[i + 2]});
}

}  // namespace

Field DesignField(Model const& model, FieldOptions const& options, Job& job) {
    far_ext::CheckForms(model.GetRefiner());
    job.Start("designing the field");
    Design design = DesignControlForm(model, options, job);

    int levels = options.levels;
    if (options.hasVertexVectors && !far_ext::HasRefinedFaces(model.GetCage()))
        levels = std::max(levels, 1);
    job.Start("subdividing the field");
    Field field;
    field.audit = std::move(design.audit);
    field.refined = MakeUniformRefiner(model.GetCage(), model.GetPath(), levels);
    field.form = Subdivide(*field.refined, std::move(design.form), field.audit, job);
    field.mesh = RefineAllButPositions(model, *field.refined, job);
    field.mesh.positions = model.GetPositions();
    for (int level = 1; level <= levels; ++level)
        field.mesh.positions = eval::RefineValues<3>(*field.refined, level, field.mesh.positions);
    job.Start("finding vectors");
    if (options.hasVertexVectors) FindVertexVectors(field);
    FindFaceVectors(field);

    auto const last = field.refined->GetLevel(levels);
    field.audit.indices = eval::FindFieldIndices(last, field.form);
    for (int euler : far_ext::FaceComponents::Find(last).FindEulerCharacteristics(last))
        field.audit.eulerCharacteristic += euler;
    return field;
}

}  // namespace limn::engine
