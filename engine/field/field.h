// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/forms/field_designer.h"
#include "eval/forms/field_index.h"
#include "eval/forms/field_match.h"

namespace limn::engine {

/// A source, sink or vortex: at a vertex or face of the control mesh.
struct FieldStrength {
    Index element = 0;
    double strength = 1.0;
};

/// What a field is made of; the parts add up.
struct FieldOptions {
    std::vector<FieldStrength>
        sources;  ///< per vertex: flow that comes out there; sinks are negative
    std::vector<FieldStrength> vortices;           ///< per face: circulation, counter-clockwise
    std::optional<std::vector<double>> harmonics;  ///< a coefficient per generator
    std::optional<std::vector<double>> edges;      ///< a given 1-form, per edge
    std::vector<eval::WantedVector> wanted;        ///< vectors to be matched
    eval::AtBoundary atBoundary = eval::AtBoundary::Tangent;
    bool isBalanced =
        false;  ///< strengths that do not add up to 0 are balanced over their component, evenly
    int levels = 0;  ///< refinements of the result
    bool hasVertexVectors =
        true;  ///< limits at vertices, too; takes one level at least where faces are not all quads
};

/// How well the field keeps its laws [Forms 8]. Curl and divergence are relative to the largest
/// value of the part's form.
struct FieldAudit {
    double maxCurlOfGradient = 0.0, maxDivergenceOfVortex = 0.0;
    double commutationD0 = 0.0,
           commutationD1 = 0.0;  ///< max |d0 S0 - S1 d0| and |d1 S1 - S2 d1| over all levels
    double gradientNorm = 0.0, vortexNorm = 0.0,
           harmonicNorm = 0.0;   ///< Hodge parts of the control form
    int numGenerators = 0;       ///< of harmonic forms
    eval::FieldIndices indices;  ///< of the refined form
    int eulerCharacteristic = 0;
    double solveSeconds = 0.0;
};

/// A field on a refined mesh.
struct Field {
    std::unique_ptr<Far::TopologyRefiner> refined;  ///< its last level is the refined mesh
    std::vector<double> form;                       ///< per edge of the refined mesh
    Scene mesh;  ///< refined; with limit normals where there are vertex vectors
    std::vector<std::array<double, 3>>
        vectors;  ///< per vertex: the limit's tangent vector; or empty
    std::vector<std::array<double, 3>> faceVectors;  ///< per face, at its middle
    FieldAudit audit;
};

/// Designs a 1-form on a control mesh, subdivides it and finds the tangent vectors it stands for.
///
/// \throws Error   BadMesh: what far_ext::CheckForms refuses, an element that does not exist,
///                 strengths that do not add up to 0 where they must, a wrong number of harmonic
///                 coefficients or of values along edges.  As RefineUniformly
/// \throws Stopped
/// Source  [Wang06] Sec. 4.2; [Forms 8]
Field DesignField(Model const& model, FieldOptions const& options, Job& job);

}  // namespace limn::engine
