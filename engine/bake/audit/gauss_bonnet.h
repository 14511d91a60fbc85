// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/bake/audit/audit_input.h"

namespace limn::engine {

/// The integral of Gaussian curvature over one component, against 2 pi chi.
struct GaussBonnetAudit {
    int component = 0;
    double integral = 0.0;  ///< texels, and discs apart
    double texelSum = 0.0;  ///< texels alone, without regard to extraordinary vertices
    double expected = 0.0;
    double relativeError = 0.0;  ///< of `integral`; its unit is max(2 pi, integral of |K|)
    bool wasAudited = false;
    std::string reason;         ///< why it was not
    bool isWithin = true;       ///< the bound, if it was audited
    Index worstFace = -1;       ///< if it is not: the face whose texels are farthest off, ...
    double worstFaceError = 0;  ///< ... and how far, of `integral`
};

/// Sums K dA over the bake's samples, with what lies round extraordinary vertices integrated apart
/// (ExtraordinaryDiscs). A component is audited if it is closed, has no infinitely sharp creases or
/// corners and no holes, and its texels neither overlap nor miss some of it.
///
/// \param bound  of relativeError
std::vector<GaussBonnetAudit> AuditGaussBonnet(AuditInput const& input, double bound = 1e-3);

}  // namespace limn::engine
