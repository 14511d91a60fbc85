// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "engine/evaluate/far_limit.h"
#include "engine/io/written_numbers.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/fit/interpolate.h"

namespace limn::engine {

struct FitOptions {
    eval::SolveMethod method = eval::SolveMethod::Automatic;
    double tolerance = 1e-6;   ///< of max |M - A P| over the diagonal of the bounding box
    int maxIterations = 1000;  ///< applications of A
    double alpha = 0.0;        ///< generalised Catmull-Clark; 0: plain
    /// Alpha in the first step, or in all: then the result is the control mesh of that scheme.
    far_ext::LimitOptions::AlphaRule alphaRule = far_ext::LimitOptions::AlphaRule::FirstStep;
    bool keepsTopology = false;  ///< with alpha in the first step: the control mesh itself, before
    /// The file that the mesh is for: its coordinates are rounded to what that will hold. None:
    /// they stay doubles.
    std::optional<MeshTarget> target{};
    /// Certifies by OpenSubdiv's limit stencils in place of the limit, and says how far they are
    /// from it.
    std::optional<FarLimitRule> farLimit{};
    /// Applies A as a table in float; residuals stay in double. Null: none.
    eval::TableEvaluator* evaluator = nullptr;

    /// \throws Error  BadOption
    void Check() const;
};

/// How far the limit surface of the result, rounded as it is, passes from the vertices that were
/// given (of those that have a limit), over the diagonal of their bounding box. Found by A's rows
/// (eval::FindVertexLimits), at a sample of vertices and at the worst without A, by refining
/// towards the vertex (eval::EvaluateVertexLimitsAt); with alpha in all steps by refining once, and
/// the limits of that level.
struct Certificate {
    double max = 0.0, rms = 0.0;
    Index worstVertex = -1;
    bool isMet = false;  ///< max is within the tolerance, as far as it is known: to a hundredth
};

struct FitResult {
    Scene mesh;  ///< the control mesh; one level finer than the input with alpha in the first step,
                 ///< unless keepsTopology
    Precision precision = Precision::Double;  ///< what its coordinates are rounded to
    eval::SolveReport report;                 ///< of the positions, before
    std::vector<eval::SolveReport> primvars;  ///< of the model's primvars, in their order
    Certificate certificate;
    std::optional<FarReport> far{};  ///< with FitOptions::farLimit, at the vertices
    double lambdaMin = 0.0;  ///< smallest eigenvalue of A, estimated; 0 if a component is singular
    double growth = 1.0;     ///< how many times as far as the data the mesh reaches, see FindGrowth
    double solveSeconds = 0.0;

    /// The solver has, and the certificate is met, by a mesh that has not run away.
    bool HasConverged() const;

    /// A has no inverse, as far as doubles tell, and the solver has added without end what A takes
    /// to nothing. The mesh is no result then.
    bool HasRunAway() const;
};

/// Finds the control mesh whose limit surface passes through the model's vertices, and fits its
/// primvars the same way. Not converging is an answer; the mesh is then the best there is, unless
/// it has run away.
///
/// Singular  A has no inverse where all vertices of a closed component have valence 3 and
///           alternate, like a cube's. Where all of them are smooth this is known beforehand, and
///           they get the solution of minimum norm; where creases end in some of them [Limit 5]
///           it shows in a mesh that runs away, if the data let it.
///
/// Where nobody has asked for a precision, it is that with which the file keeps the tolerance.
///
/// \param job     told of a precision that was not asked for, or loses too much, and of a control
///                mesh that is much larger than the model
/// \throws Error        BadMesh: a coordinate that is no number.  BadOption: alpha outside [0, 1]
///                      or with a scheme that has none; an evaluator for a factorisation; what
///                      FitOptions::Check refuses
/// \throws Stopped
/// Source  [LaiCheng11] Sec. 4; [Limit 6]
FitResult FitToLimit(Model const& model, FitOptions const& options, Job& job);

}  // namespace limn::engine
