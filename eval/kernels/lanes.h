// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before a kernel's loop over lanes, whose arrays do not overlap: g++ has to be told, clang finds
/// out by itself.
#if defined(__clang__)
#define LIMN_INDEPENDENT_LANES
#else
#define LIMN_INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif
