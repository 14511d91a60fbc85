// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "far_ext/topology/control_mesh.h"

namespace limn::engine {

/// Values that follow the vertices: a PLY's colours and further scalars.
struct Primvar {
    std::string name;
    int numChannels = 1;
    std::vector<float> values;  ///< numChannels per vertex
};

/// Which OBJ statement put a face into a group.
enum class GroupKind { Material, Group, Object };  // usemtl, g, o

/// One kind of face group; `faceGroup` is empty where the file has none of that kind.
struct FaceGroups {
    /// As they stand in the file. What follows a `g` may be several names: such a face is in each
    /// of these groups.
    std::vector<std::string> names;
    std::vector<Index> faceGroup;  ///< per face: index into names, or -1
};

/// What welding has made of a scene.
struct WeldRecord {
    double tolerance = 0.0;
    Index numJoined = 0;     ///< vertices that are parts of others now
    Index numLeftApart = 0;  ///< vertices that coincide with others all the same
};

/// A mesh as a file described it: topology with tags, positions, UVs, groups, primvars.
struct Scene {
    std::string path;    ///< as the user gave it, for messages
    std::string name;    ///< file stem
    std::string sha256;  ///< of the input bytes, hexadecimal; empty: of what is in the arrays

    far_ext::ControlMesh cage;      ///< fvar channel 0 holds the UVs where there are any
    std::vector<double> positions;  ///< 3 per vertex
    std::vector<double> normals;    ///< 3 per vertex, written to OBJ; empty without. Readers leave
                                    ///< them out: limits have their own
    std::vector<double> uvs;        ///< 2 per value of fvar channel 0; empty without UVs
    std::vector<char> lacksUVs;     ///< per face: the values of its corners stand for nothing;
                                    ///< empty where all faces have UVs, or none has
    std::array<FaceGroups, 3> groups;  ///< by GroupKind
    std::vector<Primvar> primvars;
    std::vector<uint32_t> faceLines;  ///< line of each face in a text file; empty otherwise

    std::optional<WeldRecord> weld;  ///< of engine/scene/weld.h

    /// Which options the file itself set by tags; whoever asks for others overrides them.
    bool hasBoundaryTag = false, hasFVarTag = false;

    std::vector<std::string> warnings;  ///< what the reader remarked, one line each

    bool HasUVs() const { return !uvs.empty(); }
    bool HasUVs(Index face) const { return HasUVs() && (lacksUVs.empty() || !lacksUVs[face]); }

    /// Adds the channel of texture coordinates: `values` per corner, -1 at those of faces without,
    /// of which there are some in `lacks`. \pre uvs has been filled
    void AddUVChannel(std::vector<Index> values, std::vector<char> lacks);

    /// "face 12 (line 345)", or "face 12" where the file has no lines.
    std::string NameFace(Index face) const;
};

/// The names that SelectGroups takes, each once.
std::vector<std::string> ListGroups(Scene const& scene);

/// Of one kind, those that some face is in.
std::vector<std::string> ListGroups(Scene const& scene, GroupKind kind);

/// The faces of the named groups (any kind), or an error that lists what there is.
///
/// \return one flag per face
/// \throws Error  BadOption if a name is unknown
std::vector<char> SelectGroups(Scene const& scene, std::vector<std::string> const& names);

}  // namespace limn::engine
