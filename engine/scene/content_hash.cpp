// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/content_hash.h"

#include <cstdint>
#include <type_traits>

#include "engine/scene/sha256.h"

namespace limn::engine {

namespace {

/// Takes arrays one after another, each behind its length, so that none can be taken for another.
class ContentHash {
public:
    template <class Number>
        requires std::is_arithmetic_v<Number>
    void Add(std::vector<Number> const& numbers) {
        AddBytes(numbers.data(), numbers.size(), sizeof(Number));
    }
    void Add(std::string const& text) { AddBytes(text.data(), text.size(), 1); }
    void Add(int64_t number) { _stream.Add({reinterpret_cast<char const*>(&number), 8}); }

    std::string Finish() { return _stream.Finish(); }

private:
    void AddBytes(void const* first, size_t count, size_t size) {
        Add(static_cast<int64_t>(count));
        _stream.Add({static_cast<char const*>(first), count * size});
    }

    Sha256Stream _stream;
};

void AddTopology(far_ext::ControlMesh const& cage, ContentHash& hash) {
    hash.Add(cage.numVertices);
    hash.Add(cage.faceSizes);
    hash.Add(cage.faceVertices);
    hash.Add(cage.creaseVertexPairs);
    hash.Add(cage.creaseSharpness);
    hash.Add(cage.cornerVertices);
    hash.Add(cage.cornerSharpness);
    hash.Add(cage.holes);
    hash.Add(static_cast<int64_t>(cage.fvarChannels.size()));
    for (far_ext::FVarChannel const& channel : cage.fvarChannels) {
        hash.Add(channel.numValues);
        hash.Add(channel.valueIndices);
    }
    hash.Add(cage.scheme);
    hash.Add(cage.options.GetVtxBoundaryInterpolation());
    hash.Add(cage.options.GetFVarLinearInterpolation());
    hash.Add(cage.options.GetCreasingMethod());
    hash.Add(cage.options.GetTriangleSubdivision());
}

}  // namespace

std::string HashContent(Scene const& scene, std::vector<double> const& positions) {
    ContentHash hash;
    AddTopology(scene.cage, hash);
    hash.Add(positions);
    hash.Add(scene.uvs);
    hash.Add(scene.lacksUVs);
    for (FaceGroups const& groups : scene.groups) {
        hash.Add(static_cast<int64_t>(groups.names.size()));
        for (std::string const& name : groups.names) hash.Add(name);
        hash.Add(groups.faceGroup);
    }
    hash.Add(static_cast<int64_t>(scene.primvars.size()));
    for (Primvar const& primvar : scene.primvars) {
        hash.Add(primvar.name);
        hash.Add(primvar.numChannels);
        hash.Add(primvar.values);
    }
    return hash.Finish();
}

std::string HashNumbers(std::vector<double> const& numbers) {
    ContentHash hash;
    hash.Add(numbers);
    return hash.Finish();
}

}  // namespace limn::engine
