// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/sdc/options.h>
#include <opensubdiv/sdc/types.h>

#include "far_ext/types.h"

namespace limn::far_ext {

/// Sharpness from which OpenSubdiv treats a crease or corner as infinitely sharp.
inline constexpr float kInfiniteSharpness = 10.0f;

/// Face-varying topology of one primvar: which value each corner of each face uses.
struct FVarChannel {
    Index numValues = 0;
    std::vector<Index> valueIndices;  ///< one per face corner, in the order of faceVertices
};

/// The topology of a cage: faces, tags, face-varying channels and the rules to refine them by.
/// Values (positions, UVs) live elsewhere. The order of a face's corners fixes its (s,t) domain;
/// which side is outside is for the reader of the normals to say.
struct ControlMesh {
    Index numVertices = 0;
    std::vector<Index> faceSizes;     ///< corners per face
    std::vector<Index> faceVertices;  ///< all corners, face after face

    std::vector<Index> creaseVertexPairs;  ///< two vertices per crease edge
    std::vector<float> creaseSharpness;    ///< one per pair; >= kInfiniteSharpness is infinite
    std::vector<Index> cornerVertices;
    std::vector<float> cornerSharpness;
    std::vector<Index> holes;  ///< faces that shape their neighbours but have no surface

    std::vector<FVarChannel> fvarChannels;

    Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK;
    Sdc::Options options = DefaultOptions();

    Index GetNumFaces() const { return static_cast<Index>(faceSizes.size()); }

    /// Edge and corner boundaries, corners-plus1 face-varying, uniform creases, catmark triangles.
    static Sdc::Options DefaultOptions();
};

/// Refuses what OpenSubdiv would read out of bounds or cannot hold.
///
/// \throws Error  BadMesh: no faces or vertices, a face with fewer than 3 corners, an index outside
///                its range, a crease or corner without a sharpness or with one that is negative or
///                not a number, the Loop scheme on a face that is not a triangle.  TooLarge: more
///                than 65535 corners in a face or faces and edges at a vertex (OpenSubdiv's valence
///                limit)
void Validate(ControlMesh const& mesh);

}  // namespace limn::far_ext
