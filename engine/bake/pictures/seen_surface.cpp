// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/pictures/seen_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/bake/raster/textured_faces.h"
#include "engine/scene/udim.h"
#include "eval/surface/surface_sampler.h"

namespace limn::engine {

namespace {

using Vector = Eigen::Vector3d;

/// Points about the middle of their box, so that floats hold what is to be seen of them wherever
/// they lie.
std::vector<double> Centre(std::vector<double> points) {
    Eigen::Map<Eigen::Matrix3Xd> map(points.data(), 3,
                                     static_cast<Eigen::Index>(points.size() / 3));
    if (map.cols() > 0) {
        Vector const middle = 0.5 * (map.rowwise().minCoeff() + map.rowwise().maxCoeff());
        map.colwise() -= middle;
    }
    return points;
}

/// Places of the limit on a regular grid over a domain of a face, about the middle of the mesh.
class PlaceGrid {
public:
    PlaceGrid(Model const& model, eval::LimitSurface const& surface, Orientation orientation)
        : _surface(surface),
          _positions(Centre(model.GetPositions())),
          _tree(surface, _positions, 3),
          _sampler(_tree, eval::Quantity::Normal, orientation, {3, 0}) {}

    /// Evaluates (count + 1)^2 places, of a triangle those with s + t <= 1.
    void Evaluate(Index face, int domain, int count) {
        _count = count;
        _s.clear();
        _t.clear();
        _at.clear();
        size_t const numPlaces = static_cast<size_t>(count + 1) * static_cast<size_t>(count + 1);
        _points.resize(numPlaces);
        _normals.resize(numPlaces);
        for (int j = 0; j <= count; ++j) {
            for (int i = 0; i <= (_surface.IsLoop() ? count - j : count); ++i) {
                _at.push_back(At(i, j));
                _s.push_back(static_cast<double>(i) / count);
                _t.push_back(static_cast<double>(j) / count);
            }
        }
        _sampler.Bind(face);
        _sampler.Evaluate(
            domain, _s, _t, [&](std::span<int const> samples, float const* planes, size_t stride) {
                for (size_t k = 0; k < samples.size(); ++k) {
                    size_t const at = _at[samples[k]];
                    auto const vector = [&](int channel) {
                        float const* const p = planes + static_cast<size_t>(channel) * stride + k;
                        return Vector(p[0], p[stride], p[2 * stride]);
                    };
                    _points[at] = vector(eval::kPositionX);
                    _normals[at] = vector(eval::kNormalX);
                }
            });
    }

    /// Calls visit(indices of three places) for each of its triangles.
    template <class Visit>
    void ForEachTriangle(Visit visit) const {
        for (int j = 0; j < _count; ++j) {
            for (int i = 0; i < (_surface.IsLoop() ? _count - j : _count); ++i) {
                visit(std::array{At(i, j), At(i + 1, j), At(i, j + 1)});
                if (!_surface.IsLoop() || i + j + 1 < _count)
                    visit(std::array{At(i + 1, j), At(i + 1, j + 1), At(i, j + 1)});
            }
        }
    }

    std::vector<size_t> const& GetPlaces() const { return _at; }  ///< indices of those evaluated
    double GetS(size_t k) const { return _s[k]; }                 ///< of the k-th of them
    double GetT(size_t k) const { return _t[k]; }
    size_t GetSize() const { return _points.size(); }
    Vector const& GetPoint(size_t place) const { return _points[place]; }
    Vector const& GetNormal(size_t place) const { return _normals[place]; }

private:
    size_t At(int i, int j) const {
        return static_cast<size_t>(j) * static_cast<size_t>(_count + 1) + static_cast<size_t>(i);
    }

    eval::LimitSurface const& _surface;
    std::vector<double> _positions;
    eval::FaceTree _tree;
    eval::SurfaceSampler _sampler;
    int _count = 1;
    std::vector<size_t> _at;
    std::vector<double> _s, _t;
    std::vector<Vector> _points, _normals;
};

/// Draws faces one by one.
class SurfaceLook {
public:
    SurfaceLook(Model const& model, std::vector<std::string> const& groups, Orientation orientation,
                PictureView const& view, int size, Job const& job)
        : _job(job),
          _surface(model.GetLimitSurface()),
          _faces(model, groups, job),
          _texture(_faces.surface, _faces.uvs),
          _grid(model, _surface, orientation),
          _camera(view, size),
          _seen(static_cast<size_t>(size) * static_cast<size_t>(size)) {}

    std::vector<SeenPlace> Look() {
        double const longest = IncludeAll();
        _camera.Fit();
        // A domain of a quad is as long as two of another polygon: along their common edge both
        // have the same places.
        double const most = std::sqrt(kMaxPlaces / (4.0 * std::max(1, _surface.GetNumFaces())));
        int const half = static_cast<int>(std::clamp(
            std::ceil(longest * _camera.GetScale() / kSpacing), 1.0, std::max(1.0, most)));
        ForEachDomain([&](Index face, int domain, int numDomains) {
            _grid.Evaluate(face, domain, numDomains == 1 ? 2 * half : half);
            Draw(face, domain);
        });
        return std::move(_seen);
    }

private:
    static constexpr double kSpacing = 3.0;  // samples between places
    static constexpr double kMaxPlaces = 1.6e7;

    template <class Visit>
    void ForEachDomain(Visit visit) {
        for (Index face = 0; face < _surface.GetNumFaces(); ++face) {
            if (face % 64 == 0) _job.CheckStopped();
            if (!_surface.HasLimit(face)) continue;
            int const numDomains = _surface.GetNumDomains(face);
            for (int domain = 0; domain < numDomains; ++domain) visit(face, domain, numDomains);
        }
    }

    /// Shows the camera all faces; returns about the longest half of an edge.
    double IncludeAll() {
        double longest = 0.0;
        ForEachDomain([&](Index face, int domain, int numDomains) {
            _grid.Evaluate(face, domain, numDomains == 1 ? 2 : 1);
            for (size_t place : _grid.GetPlaces()) _camera.Include(_grid.GetPoint(place));
            _grid.ForEachTriangle([&](std::array<size_t, 3> const& corners) {
                Vector const& a = _grid.GetPoint(corners[0]);
                for (size_t k : {corners[1], corners[2]})
                    longest = std::max(longest, (_grid.GetPoint(k) - a).norm());
            });
        });
        return longest;
    }

    void Draw(Index face, int domain) {
        bool const hasMap = _faces.isBaked[face];
        _uvs.assign(_grid.GetSize(), {});
        if (hasMap) {
            _texture.Bind(face);
            for (size_t k = 0; k < _grid.GetPlaces().size(); ++k)
                _uvs[_grid.GetPlaces()[k]] =
                    _texture.Evaluate(domain, _grid.GetS(k), _grid.GetT(k));
        }
        _grid.ForEachTriangle(
            [&](std::array<size_t, 3> const& corners) { DrawTriangle(corners, hasMap); });
    }

    void DrawTriangle(std::array<size_t, 3> const& corners, bool hasMap) {
        std::array<Vector, 3> projected;
        for (size_t k = 0; k < 3; ++k) projected[k] = _camera.Project(_grid.GetPoint(corners[k]));
        Vector const heights(projected[0].z(), projected[1].z(), projected[2].z());
        // On a tile's border a triangle belongs to the tile that its middle is in.
        auto const [middleU, middleV] = BlendUVs(corners, Vector::Constant(1.0 / 3.0));
        auto const tile = hasMap ? FindUdimTile(middleU, middleV) : std::nullopt;
        ForEachPixel(_camera.GetSize(), projected, [&](int x, int y, Vector const& weights) {
            double const height = weights.dot(heights);
            SeenPlace& seen = _seen[static_cast<size_t>(y) * _camera.GetSize() + x];
            if (!(height > seen.height)) return;
            auto const [u, v] = BlendUVs(corners, weights);
            seen = {height, static_cast<float>(_camera.Shade(BlendNormal(corners, weights))),
                    static_cast<float>(u), static_cast<float>(v), tile ? tile->GetNumber() : 0};
        });
    }

    std::array<double, 2> BlendUVs(std::array<size_t, 3> const& corners,
                                   Vector const& weights) const {
        std::array<double, 2> uv{};
        for (size_t c = 0; c < 2; ++c) {
            for (int k = 0; k < 3; ++k) uv[c] += weights[k] * _uvs[corners[k]][c];
        }
        return uv;
    }

    Vector BlendNormal(std::array<size_t, 3> const& corners, Vector const& weights) const {
        Vector normal = Vector::Zero();
        for (int k = 0; k < 3; ++k) normal += weights[k] * _grid.GetNormal(corners[k]);
        return normal.normalized();
    }

    Job const& _job;
    eval::LimitSurface const& _surface;
    TexturedFaces _faces;
    UVRaster _texture;
    PlaceGrid _grid;
    PictureCamera _camera;
    std::vector<SeenPlace> _seen;
    std::vector<std::array<double, 2>> _uvs;  // per place of the grid
};

}  // namespace

std::vector<SeenPlace> LookAtSurface(Model const& model, std::vector<std::string> const& groups,
                                     Orientation orientation, PictureView const& view, int size,
                                     Job const& job) {
    return SurfaceLook(model, groups, orientation, view, size, job).Look();
}

}  // namespace limn::engine
