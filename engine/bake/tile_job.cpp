// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/tile_job.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

namespace limn::engine {

TileJob::TileJob(int tile, StripBaker& baker, std::vector<FileLayout> const& files,
                 BakeOptions const& options, BakeDestination& destination, Job& job)
    : _tile(tile), _baker(baker), _files(files), _options(options), _job(job) {
    for (FileLayout const& file : files) {
        BakeOutput& output = _outputs.emplace_back();
        output.map = file.mapName;
        output.tile = tile;
        output.width = options.width;
        output.height = options.height;
        output.origin = file.FindOrigin();
        output.isAlongNormal = std::ranges::any_of(file.maps, &MapTraits::isAlongNormal);
        output.min = std::numeric_limits<float>::infinity();
        output.max = -output.min;
        _sinks.push_back(destination.Open(file, output));
    }
}

bool TileJob::HasWork() const {
    return std::any_of(_sinks.begin(), _sinks.end(),
                       [](auto const& sink) { return sink != nullptr; });
}

class TileJob::Gatherer {
public:
    /// \param halo  strips on each side that a strip's padding may read
    Gatherer(int numStrips, int halo) : _numStrips(numStrips), _halo(halo) {}

    /// \param strip  the next one; null beyond the last, so that the last ones come out, too
    /// \return       a strip whose neighbours are all there, or an empty window
    Work Add(std::shared_ptr<Strip> strip) {
        if (strip) _recent.push_back(std::move(strip));
        Work work;
        int const newest = _recent.back()->index;
        bool const isFull = newest == _next + _halo || newest == _numStrips - 1;
        if (!isFull || _next >= _numStrips) return work;
        while (_recent.front()->index < _next - _halo) _recent.erase(_recent.begin());
        work.window = _recent;
        work.at = static_cast<size_t>(_next++ - _recent.front()->index);
        return work;
    }

private:
    int _numStrips, _halo;
    int _next = 0;  // to come out
    Window _recent;
};

void TileJob::Run() {
    _job.Note(fmt::format("tile {}: {} x {} texels", _tile, _options.width, _options.height));
    TileGrid const grid = TileGrid::OfTile(_tile, _options.width, _options.height);
    FaceBins const bins(_baker.GetFaces().bounds, _baker.GetFaces().isBaked, grid, Strip::kRows,
                        Strip::kBlockColumns);
    int const numStrips = bins.GetNumStrips();
    int const halo = CountStrips(_options.padding);
    Gatherer gatherer(numStrips, halo);
    int next = 0;
    // The last filter keeps what it catches until the pipeline has run dry: TBB drops, and never
    // frees, the strips that wait before a serial filter when a filter throws.
    std::exception_ptr failure;
    std::atomic<bool> hasFailed{false};

    auto const count = [&](tbb::flow_control& control) {
        // Beyond the last strip `halo` times, so that the last ones come out of the gatherer.
        if (next == numStrips + halo || hasFailed) control.stop();
        return next++;
    };
    auto const bake = [&](int strip) -> std::shared_ptr<Strip> {
        if (strip >= numStrips) return nullptr;
        return _baker.MakeStrip(strip, grid, bins.GetStrip(strip));
    };
    auto const gather = [&](std::shared_ptr<Strip> strip) {
        return gatherer.Add(std::move(strip));
    };
    auto const pack = [&](Work const& work) -> std::shared_ptr<PackedStrip> {
        if (work.window.empty()) return nullptr;
        return std::make_shared<PackedStrip>(
            PackStrip(work.window, work.at, _options.padding, _files, _sinks, _job));
    };
    auto const write = [&](std::shared_ptr<PackedStrip> const& strip) {
        if (!strip || hasFailed) return;
        try {
            _job.CheckStopped();
            Write(*strip);
            _job.Advance();
        } catch (...) {
            failure = std::current_exception();
            hasFailed = true;
        }
    };
    using Mode = tbb::filter_mode;
    using StripPointer = std::shared_ptr<Strip>;
    using PackedPointer = std::shared_ptr<PackedStrip>;
    tbb::parallel_pipeline(static_cast<size_t>(tbb::this_task_arena::max_concurrency()) + 2,
                           tbb::make_filter<void, int>(Mode::serial_in_order, count) &
                               tbb::make_filter<int, StripPointer>(Mode::parallel, bake) &
                               tbb::make_filter<StripPointer, Work>(Mode::serial_in_order, gather) &
                               tbb::make_filter<Work, PackedPointer>(Mode::parallel, pack) &
                               tbb::make_filter<PackedPointer, void>(Mode::serial_in_order, write));
    if (failure) std::rethrow_exception(failure);
}

void TileJob::Write(PackedStrip& strip) {
    size_t firstMap = 0;
    for (size_t f = 0; f < _files.size(); ++f) {
        std::span const leftOut(strip.strip->leftOut.data() + firstMap, _files[f].maps.size());
        firstMap += leftOut.size();
        for (TangentialPart const& part : leftOut) _outputs[f].leftOut.Add(part);
        if (!_sinks[f]) continue;
        PackedStrip::Output& packed = strip.outputs[f];
        _sinks[f]->Write(packed.view, *packed.rows);
        _outputs[f].min = std::min(_outputs[f].min, packed.min);
        _outputs[f].max = std::max(_outputs[f].max, packed.max);
        _isAnyCovered |= packed.min <= packed.max;
    }
}

void TileJob::Finish(BakeReport& report) {
    bool wasMade = false;
    for (size_t f = 0; f < _files.size(); ++f) {
        if (_sinks[f]) {
            if (!_isAnyCovered) continue;
            report.clamped += _sinks[f]->Commit(_outputs[f]);
        }
        _job.Note(_outputs[f].path + (_sinks[f] ? ": done" : ": up to date"));
        report.outputs.push_back(_outputs[f]);
        if (_options.onOutput) _options.onOutput(_outputs[f]);
        wasMade = true;
    }
    if (wasMade) report.tiles.push_back(_tile);
}

}  // namespace limn::engine
