// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/types.h>
#include <opensubdiv/sdc/types.h>

namespace limn {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// OpenSubdiv's index: int. Whatever would need more is refused with ErrorCode::TooLarge.
using Index = Far::Index;

}  // namespace limn
