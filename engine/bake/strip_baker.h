// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "engine/bake/bake_options.h"
#include "engine/bake/bake_report.h"
#include "engine/bake/maps/map.h"
#include "engine/bake/raster/face_bins.h"
#include "engine/bake/raster/textured_faces.h"
#include "engine/bake/sample_averages.h"
#include "engine/bake/strip.h"
#include "eval/surface/surface_sampler.h"

namespace limn::engine {

/// From mesh to strips of texels: finds which face covers which texel, evaluates the surface there
/// and lets the maps compute their values. Everything that is built once per bake lives here.
///
/// Threads  MakeStrip may run on many threads; the same strips come out.
class StripBaker {
public:
    /// Prepares the maps. Everything is kept by reference.
    ///
    /// \throws Error  as Map::Prepare
    StripBaker(Model const& model, TexturedFaces const& faces, BakeOptions const& options,
               std::vector<std::unique_ptr<Map>> const& maps, Job& job);
    ~StripBaker();

    TexturedFaces const& GetFaces() const { return _faces; }

    /// \param grid    of the tile, without sample offsets
    /// \param blocks  per Strip::kBlockColumns columns all faces that may cover a texel there
    std::shared_ptr<Strip> MakeStrip(int index, TileGrid const& grid,
                                     FaceBins::Blocks const& blocks);

    /// Adds what was counted so far, and names the vertices samples were moved away from.
    void AddCounts(BakeReport& report, std::vector<std::string>& movedPlaces) const;

private:
    struct Pass;
    struct Worker;
    /// A map that needs face counts, apart from all passes.
    struct CountedMap {
        size_t map;  // into _maps
        int plane;   // of the strip
    };

    void ArrangePasses();
    Worker& LocalWorker();
    template <class Finish>
    void RasterSamples(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                       TexelStrip& texels, float* planes, Finish finish);
    void EvaluateHits(Worker& worker, FaceSamples const& samples,
                      far_ext::LargeArray<int> const& texels, float* planes, size_t planeSize);
    void EvaluateBlock(Worker& worker, size_t pass, FaceSamples const& samples, SampleBlock& block,
                       float const* surface, float* planes, size_t planeSize);
    void ClearBlock(TexelStrip& texels, float* planes, int firstColumn, int numColumns) const;
    void FinishBlock(Worker& worker, Strip& strip, int firstColumn, int numColumns);
    void BakeCentres(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                     Strip& strip);
    void FillCounts(Worker& worker, TexelStrip const& texels, int firstColumn, int numColumns,
                    float* planes) const;
    void CountCentres(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                      Strip& strip);
    void Supersample(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                     Strip& strip);
    std::string NamePlace(eval::SurfacePlace const& place) const;

    Model const& _model;
    TexturedFaces const& _faces;
    BakeOptions const& _options;
    std::vector<std::unique_ptr<Map>> const& _maps;
    Job& _job;
    eval::LimitSurface const& _surface;
    BakedSurface const _baked;
    std::vector<double> const _positions;  // relative to the surface's floatOrigin
    std::vector<Pass> _passes;
    std::vector<CountedMap> _countedMaps;
    std::vector<eval::FaceTree::Values> _values;  // of the faces' trees: positions, then the maps'
    int _numPlanes = 0;
    std::vector<ChannelGroup> _groups;  // of all planes
    std::vector<std::atomic<bool>> _hasTexels;
    std::atomic<size_t> _texelsCovered{0}, _newtonFailures{0};
    StripPool _pool;
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> _workers;
};

}  // namespace limn::engine
