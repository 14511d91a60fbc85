// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/bake/audit/audit_input.h"

namespace limn::engine {

/// How well a map's charts agree along texture seams.
struct SeamAudit {
    std::string map;
    size_t samples = 0;
    double max = 0.0, p99 = 0.0;  ///< in map units; of vectors the length of the difference
    std::string place;            ///< of the maximum
    std::optional<double> bound;  ///< of `max`, where there is one
    bool isWithin = true;         ///< the bound
};

/// Looks finished files up bilinearly from both sides of every seam, map by map; lines have no sign
/// to compare.
///
/// \throws Error Io where a file cannot be read back
std::vector<SeamAudit> AuditSeams(AuditInput const& input);

}  // namespace limn::engine
