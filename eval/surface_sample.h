// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where programs found this header up to 0.1; it goes with 0.3. Include
// <limn/eval/surface/surface_sample.h>.
#include "eval/surface/surface_sample.h"
