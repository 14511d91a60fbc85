// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace limn::engine {

/// The smallest and the largest value.
struct ValueRange {
    float min = 0.0f, max = 0.0f;

    bool operator==(ValueRange const&) const = default;
};

// A finished EXR file says by itself whether it is still what was written. Two attributes of its
// header are known at the end only. They are written blank, and filled in then:
//
//   kRangeAttribute   v2f     the smallest and the largest value of covered texels
//   kSealAttribute    string  64 hexadecimal digits, the SHA-256 of the file with these digits as 0
inline constexpr char const* kRangeAttribute = "limn:range";
inline constexpr char const* kSealAttribute = "limn:sha256";
inline std::string const kBlankSeal(64, '0');

/// Fills in both attributes, from what is read back of the file.
///
/// \param file   as written, with these attributes blank
/// \param check  called now and then; what it throws ends the work
/// \throws Error Io
void SealExr(std::string const& file, ValueRange const& range,
             std::function<void()> const& check = {});

/// The range of a file that is as it was sealed.
///
/// \return       nothing for a file that was changed, cut, never sealed or is no EXR file
/// \throws Error Io
std::optional<ValueRange> CheckSeal(std::string const& file,
                                    std::function<void()> const& check = {});

}  // namespace limn::engine
