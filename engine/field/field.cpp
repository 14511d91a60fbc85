// SPDX-License-Identifier: Apache-2.0
#include "engine/field/field.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/field/control_form.h"
#include "engine/scene/refine.h"
#include "eval/differential/value_refiner.h"
#include "eval/forms/vertex_covectors.h"
#include "eval/surface/vertex_limits.h"
#include "far_ext/differential/subdivision_rows.h"
#include "far_ext/forms/face_vectors.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

using Form = std::vector<double>;

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

/// Refines the form and its curl, and checks at each step that their stencils commute.
void Subdivide(eval::TableEvaluator* evaluator, Field& field, Job& job) {
    Far::TopologyRefiner const& refiner = *field.refined;
    FieldAudit& audit = field.audit;
    Form curl = far_ext::BuildD1(refiner.GetLevel(0)).Apply(field.controlForm);
    field.form = field.controlForm;
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
        field.form = eval::ApplyRows(evaluator, far_ext::FormStencils::kS1, step.s1, field.form);
        if (evaluator) curl = eval::ApplyRows(evaluator, far_ext::FormStencils::kS2, step.s2, curl);
    }
    // In double S2 of the curl is the form's own, to rounding.
    auto const last = refiner.GetLevel(refiner.GetMaxLevel());
    field.integrals = evaluator ? std::move(curl) : far_ext::BuildD1(last).Apply(field.form);
}

std::array<double, 3> ToArray(Eigen::Vector3d const& v) {
    return {v[0], v[1], v[2]};
}

void FindVertexVectors(eval::TableEvaluator* evaluator, Field& field) {
    int const last = field.refined->GetMaxLevel();
    std::vector<Index> vertices(
        static_cast<size_t>(field.refined->GetLevel(last).GetNumVertices()));
    std::iota(vertices.begin(), vertices.end(), Index(0));
    auto const covectors = eval::VertexCovectors(*field.refined, last)
                               .FindAll(vertices, field.form, field.mesh.positions, evaluator);
    field.mesh.normals.resize(field.mesh.positions.size());
    far_ext::MutablePoints const normals(field.mesh.normals);
    for (Index vertex : vertices) {
        field.vectors.push_back(ToArray(covectors[vertex].GetVector()));
        normals[vertex] = covectors[vertex].GetNormal();
    }
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
    ControlForm design = DesignControlForm(model, options, job);

    int levels = options.levels;
    if (options.hasVertexVectors && !far_ext::HasRefinedFaces(model.GetCage()))
        levels = std::max(levels, 1);
    job.Start("subdividing the field");
    Field field;
    field.audit = std::move(design.audit);
    field.refined = MakeUniformRefiner(model.GetCage(), model.GetPath(), levels);
    field.values = std::move(design.values);
    field.controlForm = std::move(design.form);
    Subdivide(options.evaluator, field, job);
    eval::ValueRefiner values(*field.refined, options.evaluator);
    field.mesh = RefineAllButPositions(model, values, job);
    field.mesh.positions = model.GetPositions();
    for (int level = 1; level <= levels; ++level) {
        field.mesh.positions = values.Refine<3>(level, field.mesh.positions);
        field.values = values.Refine<1>(level, field.values);
    }
    job.Start("finding vectors");
    if (options.hasVertexVectors) FindVertexVectors(options.evaluator, field);
    FindFaceVectors(field);

    auto const last = field.refined->GetLevel(levels);
    field.audit.indices = eval::FindFieldIndices(last, field.form);
    for (int euler : far_ext::FaceComponents::Find(last).FindEulerCharacteristics(last))
        field.audit.eulerCharacteristic += euler;
    return field;
}

std::vector<double> FindLimitValues(Field const& field) {
    auto const refiner = far_ext::CreateRefiner(field.mesh.cage);
    return eval::EvaluateVertexLimits(eval::LimitSurface(*refiner), field.values, 1).values;
}

}  // namespace limn::engine
