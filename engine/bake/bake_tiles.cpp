// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake_tiles.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "engine/scene/texture_tiles.h"
#include "engine/scene/udim.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr size_t kMaxTilesUnasked = 100;

std::string NameSome(std::vector<Index> const& faces, Model const& model) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(3, faces.size()); ++i) {
        text += (i ? ", " : "") + model.NameFace(faces[i]);
    }
    if (faces.size() > 3) text += fmt::format(" and {} more", faces.size() - 3);
    return text;
}

TextureTiles MakeTiles(TexturedFaces const& faces, BakeOptions const& options) {
    return {faces.surface, faces.uvs, options.width * options.samplesPerSide,
            options.height * options.samplesPerSide};
}

[[noreturn]] void RefuseManyTiles(Index face, TexturedFaces const& faces, Model const& model) {
    UVBounds const& b = faces.bounds[face];
    auto const tidy = [](float x) { return std::abs(x) < 1e-6f ? 0.0f : x; };  // they are loose
    throw Error(ErrorCode::BadOption,
                fmt::format("{}: more than {} tiles would be baked; with {} they are that many, "
                            "whose texture coordinates reach from ({:g}, {:g}) to ({:g}, {:g}); "
                            "name those to bake by `tiles`",
                            model.GetPath(), kMaxTilesUnasked, model.NameFace(face), tidy(b.minU),
                            tidy(b.minV), tidy(b.maxU), tidy(b.maxV)));
}

std::vector<int> FindAllTiles(TexturedFaces const& faces, Model const& model,
                              BakeOptions const& options, Job const& job) {
    TextureTiles tiles = MakeTiles(faces, options);
    for (Index face = 0; face < static_cast<Index>(faces.isBaked.size()); ++face) {
        if (!faces.isBaked[face] || tiles.HoldsAll(faces.bounds[face])) continue;
        job.CheckStopped();
        tiles.Add(face);
        if (options.tiles.empty() && tiles.GetCount() > kMaxTilesUnasked)
            RefuseManyTiles(face, faces, model);
    }
    return tiles.ListNumbers();
}

void WarnOfFacesOutOfRange(TexturedFaces const& faces, Model const& model,
                           BakeOptions const& options, Job& job) {
    TextureTiles tiles = MakeTiles(faces, options);
    std::vector<Index> outOfRange;
    for (Index face = 0; face < static_cast<Index>(faces.isBaked.size()); ++face) {
        if (!faces.isBaked[face]) continue;
        UVBounds const& b = faces.bounds[face];
        bool const isSurelyInside =
            b.minU >= 0.0f && b.maxU <= 10.0f && b.minV >= 0.0f && b.maxV <= kMaxUdimRows;
        if (!isSurelyInside && tiles.IsRangeLeftBy(face)) outOfRange.push_back(face);
    }
    if (outOfRange.empty()) return;
    job.Warn(
        fmt::format("{}: the texture coordinates of {} leave the UDIM range (u 0 to 10, v "
                    "from 0); what lies outside is not baked",
                    model.GetPath(), NameSome(outOfRange, model)));
}

void RefuseFacesElsewhere(int tile, TexturedFaces const& faces, Model const& model,
                          BakeOptions const& options) {
    TextureTiles only = MakeTiles(faces, options);
    only.AddTile(ToUdimTile(tile));
    std::vector<Index> elsewhere;
    for (Index face = 0; face < static_cast<Index>(faces.isBaked.size()); ++face) {
        if (!faces.isBaked[face] || only.HoldsAll(faces.bounds[face])) continue;
        if (only.IsLeftBy(face)) elsewhere.push_back(face);
    }
    if (elsewhere.empty()) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("{}: {} of the faces to bake lie{} in other tiles than {}: {}; put "
                            "<UDIM> into the output's name, or name one tile by `tiles`",
                            model.GetPath(), elsewhere.size(), elsewhere.size() == 1 ? "s" : "",
                            tile, NameSome(elsewhere, model)));
}

}  // namespace

std::vector<int> FindBakedTiles(TexturedFaces const& faces, Model const& model,
                                BakeOptions const& options, bool hasTileToken, Job& job) {
    auto const& asked = options.tiles;
    std::vector<int> tiles = FindAllTiles(faces, model, options, job);
    if (!hasTileToken && asked.size() != 1) {
        int const only = UdimTile{}.GetNumber();
        RefuseFacesElsewhere(only, faces, model, options);
        tiles = {only};
    }
    WarnOfFacesOutOfRange(faces, model, options, job);
    std::vector<int> baked;
    std::ranges::copy_if(tiles, std::back_inserter(baked), [&](int tile) {
        return asked.empty() || std::ranges::find(asked, tile) != asked.end();
    });
    if (baked.empty() && !tiles.empty() && !options.mayBeEmpty) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: no texel is covered in the tiles asked for; there are: {}",
                                model.GetPath(), ListTiles(tiles)));
    }
    return baked;
}

}  // namespace limn::engine
