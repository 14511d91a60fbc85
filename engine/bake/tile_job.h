// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/strip_baker.h"
#include "engine/bake/strip_packer.h"
#include "engine/bake/texel_sink.h"

namespace limn::engine {

/// One tile of a bake: strips are baked and packed on all threads, and written in order.
class TileJob {
public:
    /// Opens the tile's outputs. Everything is kept by reference.
    TileJob(int tile, StripBaker& baker, std::vector<FileLayout> const& files,
            BakeOptions const& options, BakeDestination& destination, Job& job);

    /// False if all outputs are there already.
    bool HasWork() const;

    void Run();

    /// Completes the outputs; none if no texel of the tile is covered.
    void Finish(BakeReport& report);

private:
    using Window = std::vector<std::shared_ptr<Strip>>;
    struct Work {  // a strip with the neighbours its padding reads; `at` is its place among them
        Window window;
        size_t at = 0;
    };
    /// Hands strips on as soon as their neighbours are there.
    class Gatherer;

    void Write(PackedStrip& strip);

    int _tile;
    StripBaker& _baker;
    std::vector<FileLayout> const& _files;
    BakeOptions const& _options;
    Job& _job;
    std::vector<BakeOutput> _outputs;                // per file
    std::vector<std::unique_ptr<TexelSink>> _sinks;  // per file; null where skipped
    bool _isAnyCovered = false;
};

}  // namespace limn::engine
