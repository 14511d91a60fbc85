// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/bake/audit/gauss_bonnet.h"
#include "engine/bake/audit/seam_audit.h"

namespace limn::engine {

/// What audits are judged by.
struct AuditBounds {
    double gaussBonnet = 1e-3;                ///< of the relative error
    std::optional<double> seam;               ///< of a seam's largest difference, in map units ...
    std::map<std::string, double> seamOfMap;  ///< ... and for single maps; without: not judged
};

struct AuditReport {
    std::vector<SeamAudit> seams;
    std::vector<GaussBonnetAudit> gaussBonnet;
    std::vector<std::string> misses;  ///< of bounds, in words; none if all is within
};

/// Refuses bounds for maps that are not baked. \throws Error BadOption
void CheckBounds(AuditBounds const& bounds, std::vector<std::string> const& maps);

/// Checks finished files [Bake 8], [Bake 9]: seams and the integral of Gaussian curvature. Warns
/// where there was nothing to judge.
///
/// \param bake     what Bake returned for the same mesh and options
/// \throws Error   Io where a file cannot be read back; as CheckBounds
AuditReport Audit(Model const& model, BakeOptions const& options, BakeReport const& bake,
                  AuditBounds const& bounds, Job& job);

}  // namespace limn::engine
