// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/types.h>
#include <opensubdiv/sdc/types.h>

namespace limn {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// OpenSubdiv's index: int. Whatever would need more is refused with ErrorCode::TooLarge.
using Index = Far::Index;

/// Which way faces turn, seen from outside: counter-clockwise (Right) or clockwise.
enum class Orientation { Right, Left };

/// What normals and curvatures are multiplied by: -1 turns the outside round.
constexpr double GetSign(Orientation orientation) {
    return orientation == Orientation::Right ? 1.0 : -1.0;
}

/// What numbers are written, or computed, as.
enum class Precision { Float, Double };

}  // namespace limn
