// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/curves.h"

#include <algorithm>
#include <utility>

namespace limn::engine {

RefinedCurves RefineCurves(std::vector<eval::Curve> const& curves, CurveOptions const& options,
                           Job& job) {
    job.Start("refining curves");
    RefinedCurves refined;
    for (eval::Curve const& coarse : curves) {
        job.CheckStopped();
        if (options.isDifferential) {
            auto [fine, report] =
                eval::RefineCurveDifferentially(coarse, options.rule, options.levels);
            auto& worst = refined.worst;
            worst.residual = std::max(worst.residual, report.residual);
            worst.compatibilityDefect =
                std::max(worst.compatibilityDefect, report.compatibilityDefect);
            refined.curves.push_back(std::move(fine));
            continue;
        }
        eval::Curve& fine = refined.curves.emplace_back(coarse);
        for (int level = 0; level < options.levels; ++level)
            fine = eval::SubdivideCurve(fine, options.rule);
    }
    return refined;
}

}  // namespace limn::engine
