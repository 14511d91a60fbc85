// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "engine/differential/curvature_edit.h"
#include "engine/io/written_numbers.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/differential/mesh_curvature.h"
#include "eval/stencils/table_evaluator.h"
#include "far_ext/differential/subdivision_rows.h"

namespace limn::engine {

enum class Laplacian { Combinatorial, Cotangent, Mesh };

enum class DifferentialSolver { Multigrid, Cholesky };

struct DifferentialOptions {
    int levels = 1;  ///< 0 to 10, those in space included
    far_ext::TunedRule rule{};
    Laplacian laplacian = Laplacian::Combinatorial;
    int dirMagLevels = 0;   ///< levels done by direction and magnitude
    int spatialLevels = 0;  ///< levels done in space before
    std::vector<Index> handles;
    DifferentialSolver solver = DifferentialSolver::Multigrid;
    double tolerance = 1e-8;     ///< of the linear solve's residual
    double fitTolerance = 0.01;  ///< of the residual with a Laplacian that knows areas
    CurvatureEdit edit;
    /// Applies the rule, on coordinates and in space, as tables in float; null: in double.
    /// Directions and magnitudes are in double.
    eval::TableEvaluator* evaluator = nullptr;
    Orientation orientation = Orientation::Right;
    /// The file that the mesh is for: its coordinates are rounded to what that will hold. None:
    /// they stay doubles.
    std::optional<MeshTarget> target{};
};

/// What became of an edit at a vertex.
struct EditOutcome {
    EditTarget target;
    /// Mean curvature of the result there, by the tensor of its dihedral angles, or by how many
    /// degrees its normal is off; none on a boundary, which has no mean curvature.
    std::optional<double> reached{};
};

/// How long the parts of the work took.
struct DifferentialStages {
    double coordinates = 0.0, subdivision = 0.0, reconstruction = 0.0;
};

struct DifferentialReport {
    Index unknowns = 0;
    int iterations = 0;
    DifferentialStages seconds;  ///< of reconstruction: set-up of the solver included
    double residual = 0.0;       ///< of the positions handed back
    double rounding = 0.0;       ///< what of it the positions' being doubles may account for
    double compatibilityDefect = 0.0;
    bool converged = false;
    int fitSteps = 0;              ///< of the fit to a Laplacian that knows areas
    bool hasFitStalled = false;    ///< it ended short of the tolerance, since steps gained little
    double tangentialShare = 0.0;  ///< of the differential coordinates; see eval::DirMag
    double sizeRatio =
        1.0;  ///< rms distance from the mean vertex, over that of the spatial refinement
    Precision precision = Precision::Double;  ///< what the mesh's coordinates are rounded to
    eval::ThinPlateEnergy energy;             ///< of the rounded mesh, and so are size and edits
    std::vector<EditOutcome> edits;
};

struct DifferentialResult {
    Scene mesh;
    DifferentialReport report;
};

/// Subdivides differential coordinates instead of positions, then finds the mesh that has them.
///
/// Boundaries follow the curve rule (edge-only) whatever the model's option, in coordinates and in
/// space. The result has RefineUniformly's topology, attributes and vertex order; handles lie where
/// that puts them. Its size is not the spatial one's, and nothing rescales it.
///
/// \param job     told of creases, which get round, of results that are not what was wanted, and of
///                a precision that was not asked for or loses too much
/// \throws Error  as RefineUniformly; BadOption: contradicting levels or handles.  BadMesh:
///                boundaries that meet in a vertex, an edit of a vertex that is not there, with
///                cotangents a triangle without area. Unsupported: a Laplacian or rule that needs
///                triangles.  TooLarge: more than 20000 vertices with the mesh Laplace operator
/// \throws Stopped
/// Source  [Zhu11]
DifferentialResult RefineDifferentially(Model const& model, DifferentialOptions const& options,
                                        Job& job);

}  // namespace limn::engine
