// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/morph_schedule.h"

#include <fmt/format.h>

#include "engine/io/number_table.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr int kMaxDetail = 1000;

}  // namespace

std::vector<MorphStep> ReadMorphSchedule(std::string const& path) {
    NumberTable const table = ReadNumberTable(path, {{"step", "detail", "rate"}});
    auto const refuse = [&](size_t row, std::string const& why) {
        throw Error(ErrorCode::BadMesh, fmt::format("{}:{}: {}", path, table.lines[row], why));
    };
    if (table.GetNumRows() == 0)
        throw Error(ErrorCode::BadMesh, fmt::format("{}: a schedule of no steps", path));
    std::vector<MorphStep> steps;
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        double const step = table.Get(row, 0), rate = table.Get(row, 2);
        if (row >= kMaxMorphSteps) refuse(row, fmt::format("more than {} steps", kMaxMorphSteps));
        if (step != static_cast<double>(row + 1)) {
            refuse(row, fmt::format("step {} stands where step {} should; steps are 1, 2, ... in "
                                    "order",
                                    step, row + 1));
        }
        if (!(rate > 0.0 && rate < 1.0))
            refuse(row, fmt::format("rate {} is not between 0 and 1", rate));
        steps.push_back({GetIndex(table, path, row, 1, kMaxDetail + 1, "detail"), rate});
    }
    return steps;
}

}  // namespace limn::engine
