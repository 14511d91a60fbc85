// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/raster/textured_faces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

eval::LimitSurface const& RequireTextureSurface(Model const& model) {
    if (model.HasUVs()) return model.GetTextureSurface();
    throw Error(ErrorCode::BadMesh,
                fmt::format("{}: the mesh has no texture coordinates; a bake needs them ('vt' in "
                            "OBJ, s,t in PLY)",
                            model.GetPath()));
}

/// Texels are found in double, which at more than this many tiles from 1001 tells those of the
/// largest images apart no more.
constexpr double kFarthestUV = 1e4;

/// Refuses the first baked face that reaches too far.
void RefuseFarUVs(Model const& model, std::vector<char> const& isBaked) {
    auto const& values = model.GetCage().fvarChannels[0].valueIndices;
    size_t corner = 0;
    for (Index face = 0; face < model.GetCage().GetNumFaces(); ++face) {
        for (int i = 0; i < model.GetCage().faceSizes[face]; ++i, ++corner) {
            double const* const uv = &model.GetUVs()[2 * static_cast<size_t>(values[corner])];
            double const farthest = std::max(std::abs(uv[0]), std::abs(uv[1]));
            if (!isBaked[face] || farthest <= kFarthestUV) continue;
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: {} has a texture coordinate of {}; up to {} in magnitude "
                                    "can be baked",
                                    model.GetPath(), model.NameFace(face), farthest, kFarthestUV));
        }
    }
}

std::vector<char> SelectFaces(Model const& model, std::vector<std::string> const& groups,
                              eval::LimitSurface const& surface) {
    std::vector<char> isBaked(model.GetCage().faceSizes.size(), 1);
    if (!groups.empty()) isBaked = model.SelectGroups(groups);
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!model.HasUVs(face) || !surface.HasLimit(face)) isBaked[face] = 0;
    }
    RefuseFarUVs(model, isBaked);
    return isBaked;
}

std::vector<UVBounds> FindBounds(TexturedFaces const& faces, Job const& job) {
    std::vector<UVBounds> bounds(faces.isBaked.size());
    tbb::enumerable_thread_specific<UVRaster> rasters(
        [&] { return UVRaster(faces.surface, faces.uvs); });
    tbb::parallel_for(tbb::blocked_range<Index>(0, faces.surface.GetNumFaces(), 512),
                      [&](auto const& range) {
                          job.CheckStopped();
                          UVRaster& raster = rasters.local();
                          for (Index face = range.begin(); face != range.end(); ++face) {
                              if (faces.isBaked[face]) bounds[face] = raster.GetBounds(face);
                          }
                      });
    return bounds;
}

}  // namespace

TexturedFaces::TexturedFaces(Model const& model, std::vector<std::string> const& groups,
                             Job const& job)
    : surface(RequireTextureSurface(model)),
      uvs(model.GetUVs()),
      isBaked(SelectFaces(model, groups, surface)),
      bounds(FindBounds(*this, job)) {}

}  // namespace limn::engine
