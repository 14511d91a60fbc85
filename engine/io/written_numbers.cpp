// SPDX-License-Identifier: Apache-2.0
#include "engine/io/written_numbers.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/io/file.h"

namespace limn::engine {

namespace {

/// What mesh files hold of a number in text: the shortest digits that read back as the same float.
double RoundThroughText(float value) {
    char digits[32];
    auto const written = fmt::format_to_n(digits, sizeof digits, "{}", value);
    double read = value;
    std::from_chars(digits, written.out, read);
    return read;
}

}  // namespace

Precision FindPrecision(MeshTarget const& target, Extent const& extent, double share) {
    Precision const enough = AreFloatsEnough(extent, share) ? Precision::Float : Precision::Double;
    return target.precision.value_or(enough);
}

void WarnOfPrecision(MeshTarget const& target, Extent const& extent, Job& job, double share) {
    if (target.precision == Precision::Double || AreFloatsEnough(extent, share)) return;
    std::string const loss = fmt::format(
        "are off by up to {:.2g}, {:.2g} of the size {:.4g} of this mesh, whose "
        "coordinates reach {:.7g}",
        FindFloatError(extent), FindFloatError(extent) / extent.GetDiagonal(), extent.GetDiagonal(),
        extent.GetFarthest());
    job.Warn(target.precision
                 ? fmt::format("{}: floats {}; `precision` double keeps it all", target.path, loss)
                 : fmt::format("{}: in double, for floats {}", target.path, loss));
}

Precision ChoosePrecision(MeshTarget const& target, Extent const& extent, Job& job, double share) {
    WarnOfPrecision(target, extent, job, share);
    return FindPrecision(target, extent, share);
}

void RoundAsWritten(std::string const& path, Precision precision, std::span<double> positions) {
    if (precision == Precision::Double) return;  // 17 digits, or 8 bytes, hold it
    constexpr double kLargest = std::numeric_limits<float>::max();
    bool const isText = GetEnding(path) == ".obj";
    tbb::parallel_for(tbb::blocked_range<size_t>(0, positions.size(), 4096),
                      [&](auto const& range) {
                          for (double& x : positions.subspan(range.begin(), range.size())) {
                              if (!(std::abs(x) <= kLargest))
                                  continue;  // which no file will be written of
                              float const rounded = static_cast<float>(x);
                              x = isText ? RoundThroughText(rounded) : rounded;
                          }
                      });
}

}  // namespace limn::engine
