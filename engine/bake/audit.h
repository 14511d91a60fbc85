#pragma once

#include <string>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/bake/bake.h"

namespace limn::engine {

/// How well a map's charts agree along texture seams.
struct SeamAudit {
    std::string map;
    size_t samples = 0;
    double max = 0.0, p99 = 0.0;  ///< in map units; of vectors the length of the difference
    std::string place;            ///< of the maximum
};

/// The integral of Gaussian curvature over the texels of one component, against 2 pi chi.
struct GaussBonnetAudit {
    int component = 0;
    double integral = 0.0, expected = 0.0, relativeError = 0.0;
    bool wasAudited = false;
    std::string reason;  ///< why it was not
};

struct AuditReport {
    std::vector<SeamAudit> seams;
    std::vector<GaussBonnetAudit> gaussBonnet;
    bool isWithin = true;  ///< every audited component keeps the bound
};

/// Checks finished files (bake.md, "Audits"): seams by looking the files up bilinearly from both sides,
/// Gauss-Bonnet by summing K dA over the texels' centres. A component is audited if it is closed, has no
/// infinitely sharp creases or corners and no holes, and its texels neither overlap nor miss some of it.
///
/// The sum over texels needs no special care at extraordinary vertices: Gaussian curvature grows there
/// slower than 1/distance, so that the texel next to one adds an error of the order of its own share.
///
/// \param bake   what Bake returned for the same scene and options
/// \param bound  of the relative error, whose unit is max(2 pi, integral of |K|)
/// \throws Error Io where a file cannot be read back
AuditReport Audit(Scene const& scene, Far::TopologyRefiner const& refiner, BakeOptions const& options,
                  BakeReport const& bake, double bound, Job& job);

}  // namespace limn::engine
