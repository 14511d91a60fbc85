// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::far_ext {

/// The components of a mesh: faces that hang together by shared vertices, numbered by their lowest
/// face.
struct FaceComponents {
    int count = 0;
    std::vector<int> ofFace;

    static FaceComponents Find(Far::TopologyLevel const& level);

    /// Vertices - edges + faces, per component; vertices without faces count nowhere.
    std::vector<int> FindEulerCharacteristics(Far::TopologyLevel const& level) const;
};

}  // namespace limn::far_ext
