// SPDX-License-Identifier: Apache-2.0
#include "engine/field/field_texture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "engine/bake/raster/face_bins.h"
#include "engine/bake/raster/textured_faces.h"
#include "engine/field/field_levels.h"
#include "engine/images/channel_image.h"
#include "eval/forms/place_match.h"
#include "eval/surface/refined_faces.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

/// Faces refined as often are the cells of a 4 x 4 lattice, of which each has a texel.
constexpr int kLatticeLevels = 2;

/// A texel on the surface.
struct CoveredTexel {
    Index face = -1;
    int domain = 0;
    double s = 0.0, t = 0.0;
    double distance = std::numeric_limits<double>::infinity();  // squared, from its cell's middle
    std::array<float, 3> value{};
};

/// Finds the texels that are to be met: one for each cell of the lattice.
class TexelChooser {
public:
    TexelChooser(Model const& model, FieldTexture const& texture, Job& job)
        : _model(model),
          _texture(texture),
          _job(job),
          _faces(model, {}, job),
          _cells(model.GetLimitSurface(), kLatticeLevels),
          _middle(model.GetLimitSurface().IsLoop() ? 1.0 / 3.0 : 0.5),
          _raster(_faces.surface, _faces.uvs) {}

    /// Cells without a texel have one of face -1.
    std::vector<CoveredTexel> const& Choose();
    /// After Choose: how often forms of a bake into these images are refined.
    int GetLevels() const { return _levels; }

private:
    std::set<int> ListTiles() const;
    void ReadTile(std::string const& path, int number);
    void TakeFace(Index face, std::vector<TexelHits> const& hits, TexelStrip const& strip,
                  ChannelImage const& image, std::string const& path);

    Model const& _model;
    FieldTexture const& _texture;
    Job& _job;
    TexturedFaces _faces;
    eval::RefinedFaces _cells;
    double _middle;  // of a cell, s and t
    UVRaster _raster;
    int _levels = std::numeric_limits<int>::max();
    std::vector<CoveredTexel> _texels;  // per cell
};

/// All that the faces may reach.
std::set<int> TexelChooser::ListTiles() const {
    std::set<int> tiles;
    for (size_t face = 0; face < _faces.bounds.size(); ++face) {
        if (!_faces.isBaked[face]) continue;
        auto const& [minU, maxU, minV, maxV] = _faces.bounds[face];
        auto const toTile = [](float value, int count) {
            return static_cast<int>(
                std::clamp(std::floor(value), -1.0f, static_cast<float>(count)));
        };
        int const lastU = std::min(toTile(maxU, 10), 9),
                  lastV = std::min(toTile(maxV, kMaxUdimRows), kMaxUdimRows - 1);
        for (int v = std::max(0, toTile(minV, kMaxUdimRows)); v <= lastV; ++v) {
            for (int u = std::max(0, toTile(minU, 10)); u <= lastU; ++u)
                tiles.insert(UdimTile{u, v}.GetNumber());
        }
    }
    return tiles;
}

std::vector<CoveredTexel> const& TexelChooser::Choose() {
    bool const hasTiles = HasUdimToken(_texture.pattern);
    bool hasImage = false;
    for (int number : hasTiles ? ListTiles() : std::set<int>{1001}) {
        std::string const path = ReplaceUdimToken(_texture.pattern, number);
        if (hasTiles && !std::filesystem::exists(path)) continue;
        ReadTile(path, number);
        hasImage = true;
    }
    if (!hasImage) {
        throw Error(ErrorCode::Io, fmt::format("{}: there is no image of a tile that '{}' reaches",
                                               _texture.pattern, _model.GetPath()));
    }
    return _texels;
}

void TexelChooser::ReadTile(std::string const& path, int number) {
    _job.Start("reading " + path);
    ChannelImage const image = ReadChannels(path, {"R", "field.R"}, _texture.isFlow ? 2 : 3);
    _levels = std::min(_levels, ChooseFieldLevels(_model, image.width, image.height));
    constexpr int kStripRows = 64;
    TileGrid const grid = TileGrid::OfTile(number, image.width, image.height);
    FaceBins const bins(_faces.bounds, _faces.isBaked, grid, kStripRows, grid.width);
    TexelStrip strip;
    for (int index = 0; index < bins.GetNumStrips(); ++index) {
        _job.CheckStopped();
        int const firstRow = index * kStripRows;
        strip.Reset(firstRow, std::min(kStripRows, grid.height - firstRow), grid.width);
        for (Index face : bins.GetStrip(index)[0])
            TakeFace(face, _raster.Rasterise(face, grid, strip), strip, image, path);
    }
}

void TexelChooser::TakeFace(Index face, std::vector<TexelHits> const& hits, TexelStrip const& strip,
                            ChannelImage const& image, std::string const& path) {
    for (int domain = 0; domain < _faces.surface.GetNumDomains(face); ++domain) {
        auto const& [texels, s, t] = hits[domain];
        for (size_t i = 0; i < texels.size(); ++i) {
            int const x = texels[i] % strip.width, y = strip.firstRow + texels[i] / strip.width;
            CoveredTexel texel{face, domain, s[i], t[i]};
            for (int c = 0; c < image.numChannels; ++c) {
                float const value = image.Get(x, y, c);
                texel.value[c] = value;
                if (std::isfinite(value)) continue;
                throw Error(ErrorCode::BadMesh,
                            fmt::format("{}: pixel {},{} is {}; {} lies there, and a field has "
                                        "finite numbers",
                                        path, x, y, value, _model.NameFace(face)));
            }
            auto const cell = _cells.Find({face, domain, texel.s, texel.t});
            double const ds = cell.s - _middle, dt = cell.t - _middle;
            texel.distance = ds * ds + dt * dt;
            if (_texels.size() <= static_cast<size_t>(cell.face))
                _texels.resize(static_cast<size_t>(cell.face) + 1);
            CoveredTexel& best = _texels[cell.face];
            if (texel.distance < best.distance) best = texel;
        }
    }
}

/// Turns texels into vectors on the surface, each with the area of its cell.
class VectorFinder {
public:
    VectorFinder(Model const& model, bool isFlow)
        : _surface(model.GetLimitSurface()),
          _isFlow(isFlow),
          _tree(_surface, model.GetPositions(), 3),
          _raster(model.GetTextureSurface(), model.GetUVs()) {}

    /// None where a flow in texture coordinates is none on the surface.
    std::optional<eval::WantedAtPlace> Find(CoveredTexel const& texel) {
        if (_tree.GetFace() != texel.face) {
            _tree.Bind(texel.face);
            _raster.Bind(texel.face);
        }
        auto const at = eval::EvaluateDerivatives(_tree, texel.domain, texel.s, texel.t);
        double const cell =
            (_surface.IsLoop() ? 0.5 : 1.0) / (_surface.GetNumDomains(texel.face) > 1 ? 4.0 : 16.0);
        eval::WantedAtPlace wanted{{texel.face, texel.domain, texel.s, texel.t},
                                   {texel.value[0], texel.value[1], texel.value[2]},
                                   cell * at.ds.cross(at.dt).norm()};
        if (!_isFlow) return wanted;
        auto const [us, ut, vs, vt] = _raster.GetJacobian(texel.domain, texel.s, texel.t);
        double const determinant = us * vt - ut * vs, du = texel.value[0], dv = texel.value[1];
        if (!(std::abs(determinant) > 1e-14 * (std::abs(us * vt) + std::abs(ut * vs)))) return {};
        wanted.vector = ((vt * du - ut * dv) * at.ds + (us * dv - vs * du) * at.dt) / determinant;
        return wanted;
    }

private:
    eval::LimitSurface const& _surface;
    bool _isFlow;
    eval::FaceTree _tree;
    UVRaster _raster;
};

/// Refuses images that tell nothing of the surface, and warns of faces of which they do not.
void JudgeFaces(Model const& model, FieldTexture const& texture, std::vector<char> const& hasTexel,
                Job& job) {
    Index numFaces = 0, numBare = 0, firstBare = -1;
    for (Index face = 0; face < model.GetLimitSurface().GetNumFaces(); ++face) {
        if (!model.GetLimitSurface().HasLimit(face)) continue;
        ++numFaces;
        if (hasTexel[face]) continue;
        if (numBare++ == 0) firstBare = face;
    }
    if (numBare == numFaces) {
        throw Error(ErrorCode::BadMesh, fmt::format("{}: no texel of {} lies on the surface",
                                                    model.GetPath(), texture.pattern));
    }
    if (numBare == 0) return;
    job.Warn(fmt::format(
        "{}: {} of {} faces have no texel of {}, first {}: the field there comes "
        "from those round them",
        model.GetPath(), numBare, numFaces, texture.pattern, model.NameFace(firstBare)));
}

}  // namespace

std::vector<double> MatchFieldTexture(Model const& model, FieldTexture const& texture, Job& job) {
    if (!model.HasUVs()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the mesh has no texture coordinates; `FieldTexture` needs "
                                "them ('vt' in OBJ, s,t in PLY)",
                                model.GetPath()));
    }
    TexelChooser chooser(model, texture, job);
    VectorFinder finder(model, texture.isFlow);
    std::vector<eval::WantedAtPlace> wanted;
    std::vector<char> hasTexel(model.GetCage().faceSizes.size(), 0);
    for (CoveredTexel const& texel : chooser.Choose()) {
        if (texel.face < 0) continue;
        hasTexel[texel.face] = 1;
        if (auto const found = finder.Find(texel)) wanted.push_back(*found);
    }
    JudgeFaces(model, texture, hasTexel, job);
    job.Start("matching texels");
    int const levels = std::clamp(chooser.GetLevels(), 1, kLatticeLevels);
    return eval::MatchPlaces(model.GetCage(), model.GetLimitSurface(), model.GetPositions(), wanted,
                             levels, [&] { job.CheckStopped(); });
}

}  // namespace limn::engine
