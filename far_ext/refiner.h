// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where programs found this header up to 0.1; it goes with 0.3. Include
// <limn/far_ext/topology/refiner.h>.
#include "far_ext/topology/refiner.h"
