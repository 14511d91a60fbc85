// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/field/field_texture.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/forms/field_designer.h"
#include "eval/forms/field_index.h"
#include "eval/forms/field_match.h"
#include "eval/forms/least_connection.h"
#include "eval/forms/pinned_function.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::engine {

/// A source, sink or vortex: at a vertex or face of the control mesh.
struct FieldStrength {
    Index element = 0;
    double strength = 1.0;
};

/// What the field does all along a boundary loop: a total, shared out by length.
struct BoundaryLoop {
    Index vertex = 0;            ///< any of the loop
    bool isCirculation = false;  ///< else flux, outwards
    double total = 0.0;          ///< circulation with the surface on the left
};

/// The same along one edge of a boundary.
struct BoundaryEdge {
    Index edge = 0;
    bool isCirculation = false;
    double value = 0.0;  ///< circulation from the lower vertex to the higher one
};

/// What a field is made of; the parts add up.
struct FieldOptions {
    std::vector<FieldStrength>
        sources;  ///< per vertex: flow that comes out there; sinks are negative
    std::vector<FieldStrength> vortices;           ///< per face: circulation, counter-clockwise
    std::optional<std::vector<double>> harmonics;  ///< a coefficient per generator
    std::optional<std::vector<double>> edges;      ///< a given 1-form, per edge
    std::vector<eval::WantedVector> wanted;        ///< vectors to be matched
    std::optional<FieldTexture> texture;           ///< images of vectors to be matched
    std::optional<std::vector<double>> values;     ///< a function per vertex; its gradient counts
    std::vector<eval::Pin> pins;  ///< a function that is harmonic between them; likewise
    std::optional<std::vector<double>> integrals;  ///< per face: further vortices
    std::vector<eval::WantedIndex> singularities;  ///< of a field of unit vectors
    // Boundary data, over `atBoundary`. With any of it sources and vortices have no harmonics.
    std::vector<BoundaryLoop> loops;
    std::vector<BoundaryEdge> boundaryEdges;
    std::vector<FieldStrength> arcFluxes;  ///< per vertex of an arc of given circulation, outwards
    eval::AtBoundary atBoundary = eval::AtBoundary::Tangent;
    bool isBalanced =
        false;  ///< strengths that do not add up to 0 are balanced over their component, evenly
    int levels = 0;  ///< refinements of the result
    bool hasVertexVectors =
        true;  ///< limits at vertices, too; takes one level at least where faces are not all quads
    /// Applies refinement and vectors at vertices as tables, in float; null: all in double.
    eval::TableEvaluator* evaluator = nullptr;
};

/// What a field does along boundaries that it has data for.
struct BoundaryAudit {
    struct Loop {
        Index vertex = 0;       ///< the lowest
        char const* kind = "";  ///< tangent, normal, circulation, flux, mixed
        double circulation = 0.0, flux = 0.0;
    };
    std::vector<Loop> loops;
    double residual = 0.0;  ///< of its equations, over the largest number in them
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
    std::optional<BoundaryAudit> boundary;  ///< with boundary data
    double solveSeconds = 0.0;
};

/// A field on a refined mesh.
struct Field {
    std::unique_ptr<Far::TopologyRefiner> refined;  ///< its last level is the refined mesh
    std::vector<double> controlForm;                ///< per edge of the mesh
    std::vector<double> form;                       ///< per edge of the refined mesh
    std::vector<double> values;     ///< per vertex of it: the function whose gradient the field has
    std::vector<double> integrals;  ///< per face of it: the field's curl
    Scene mesh;                     ///< refined; with limit normals where there are vertex vectors
    std::vector<std::array<double, 3>>
        vectors;  ///< per vertex: the limit's tangent vector; or empty
    std::vector<std::array<double, 3>> faceVectors;  ///< per face, at its middle
    FieldAudit audit;
};

/// Designs a 1-form on a control mesh, subdivides it and finds the tangent vectors it stands for.
///
/// \throws Error   BadMesh: what far_ext::CheckForms refuses, an element that does not exist,
///                 strengths that do not add up to 0 where they must, a wrong number of harmonic
///                 coefficients or of values along edges; as DesignBounded; indices that no field
///                 can have.  BadOption: a single pin.  As RefineUniformly
///                As MatchFieldTexture
/// \throws Stopped
/// Source  [Wang06] Sec. 4.2; [Forms 8]
Field DesignField(Model const& model, FieldOptions const& options, Job& job);

/// The limits of `values` at the vertices of the field's mesh.
std::vector<double> FindLimitValues(Field const& field);

}  // namespace limn::engine
