// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "engine/bake/bake.h"
#include "engine/bake/layout.h"
#include "engine/bake/uv_raster.h"
#include "engine/noise/surface_noise.h"
#include "eval/forms/field_surface.h"
#include "eval/surface/finer_surface.h"
#include "eval/surface/surface_sampler.h"

namespace limn::engine {

/// A run of texel rows of one tile after evaluation, before padding.
struct Band {
    static constexpr int kRows = ExrSpec::kTileSize;
    static constexpr int kBlockColumns = 512;  ///< baked together: their values stay in the cache

    int index = 0;  ///< rows [kRows * index, ...)
    TexelBand texels;
    UninitializedVector<float> planes;  ///< [plane][row][column]; 0 where nothing is covered
    std::vector<uint8_t> isCovered;     ///< [row][column]
    std::vector<uint8_t> isFilled;      ///< [row][column]: covered, or padded by PackBand
    std::vector<float> coverage;        ///< [row][column], 0 to 1; empty without supersampling
    std::vector<float> low, high;  ///< per plane, over covered texels; low > high if there are none
    size_t numCovered = 0;

    size_t GetNumTexels() const { return isCovered.size(); }
    float GetCoverage(size_t texel) const {
        return coverage.empty() ? static_cast<float>(isCovered[texel]) : coverage[texel];
    }
};

/// From mesh to bands of texels: finds which face covers which texel, evaluates the surface there
/// and computes the maps. Everything that is built once per bake lives here.
///
/// Threads  MakeBand may run on many threads; the same bands come out.
class BandBaker {
public:
    /// \param other    null, or a mesh of the same faces, or of these refined uniformly
    /// \throws Error  BadMesh: no UVs; --against with other faces
    BandBaker(Scene const& scene, Far::TopologyRefiner const& refiner, Scene const* other,
              BakeOptions const& options, std::vector<Map> const& maps);

    ~BandBaker();

    /// Bounds of a face's texture coordinates; meaningless where !IsBaked.
    UVBounds const& GetBounds(Index face) const { return _bounds[face]; }
    bool IsBaked(Index face) const { return _isBaked[face]; }
    Index GetNumFaces() const { return _surface->GetNumFaces(); }

    /// True if some place of the face lies outside u in [0, 10], v >= 0 by more than rounding.
    bool LeavesUdimRange(Index face);

    /// \param grid   of the tile, without sample offsets
    /// \param blocks  per Band::kBlockColumns columns all faces that may cover a texel there,
    ///                ascending
    /// \return a band whose memory comes from, and goes back to, one that is done with
    std::shared_ptr<Band> MakeBand(int index, TileGrid grid,
                                   std::vector<std::vector<Index>> const& blocks);

    /// Adds what was counted so far, and names the vertices samples were moved away from.
    void AddCounts(BakeReport& report, std::vector<std::string>& movedPlaces) const;

private:
    struct Worker;

    Worker& LocalWorker();
    template <class Finish>
    void RasterSamples(Worker& worker, TileGrid const& grid,
                       std::vector<std::vector<Index>> const& blocks, TexelBand& texels,
                       float* planes, Finish finish);
    void EvaluateHits(Worker& worker, Index face, int domain, TexelHits const& hits, float* planes,
                      size_t planeSize);
    std::shared_ptr<Band> AcquireBand(int index, TileGrid const& grid);
    void ClearBlock(TexelBand& texels, float* planes, int firstColumn, int numColumns) const;
    void FinishBlock(Band& band, int firstColumn, int numColumns);
    void Supersample(Worker& worker, TileGrid const& grid,
                     std::vector<std::vector<Index>> const& blocks, Band& band);
    double FindMeanArea();
    std::string NamePlace(eval::SurfaceSampler::Place const& place) const;

    Scene const& _scene;
    Far::TopologyRefiner const& _refiner;
    BakeOptions const& _options;
    std::vector<Map> const& _maps;
    eval::Quantity _quantity;
    bool _needsJacobian = false;
    int _numPlanes = 0;
    std::vector<double> _primvarValues, _frequencyBands;
    std::vector<eval::FaceTree::Values> _values;
    std::unique_ptr<eval::LimitSurface> _surface, _uvSurface;
    std::unique_ptr<SurfaceNoise> _noise;        // null where no map shows it
    std::unique_ptr<eval::FieldSurface> _field;  // likewise
    std::optional<eval::FinerSurface> _finer;    // --against, where its faces are refined ones
    std::vector<char> _isBaked;
    std::vector<UVBounds> _bounds;
    double _meanArea = 1.0;  // surface area per texture area
    std::vector<std::atomic<bool>> _hasTexels;
    std::atomic<size_t> _texelsCovered{0}, _overlaps{0}, _newtonFailures{0};
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> _workers;
    std::mutex _poolMutex;
    std::vector<std::unique_ptr<Band>> _pool;
};

}  // namespace limn::engine
