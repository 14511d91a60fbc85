// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/audit/gauss_bonnet.h"
#include "engine/bake/audit/seam_audit.h"

namespace limn::engine {

struct AuditReport {
    std::vector<SeamAudit> seams;
    std::vector<GaussBonnetAudit> gaussBonnet;
    bool isWithin = true;  ///< every audited component keeps the bound
};

/// Checks finished files [Bake 8], [Bake 9]: seams and the integral of Gaussian curvature.
///
/// \param bake   what Bake returned for the same mesh and options
/// \param bound  of the relative error of Gauss-Bonnet
/// \throws Error Io where a file cannot be read back
AuditReport Audit(Model const& model, BakeOptions const& options, BakeReport const& bake,
                  double bound, Job& job);

}  // namespace limn::engine
