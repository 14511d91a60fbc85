// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/memory_sink.h"

#include <algorithm>

namespace limn::engine {

namespace {

class MemorySink : public TexelSink {
public:
    MemorySink(FileLayout const& file, BakeOutput const& output, std::vector<BakedImage>& images)
        : _numChannels(file.numPlanes), _images(images) {
        _image.map = output.map;
        _image.tile = output.tile;
        _image.width = output.width;
        _image.height = output.height;
        _image.channels.assign(file.channelNames.begin(),
                               file.channelNames.begin() + file.numPlanes);
        size_t const numTexels =
            static_cast<size_t>(output.width) * static_cast<size_t>(output.height);
        _image.texels.resize(numTexels * static_cast<size_t>(_numChannels));
        _image.coverage.resize(numTexels);
    }

    bool WantsCoverage() const override { return true; }

    std::unique_ptr<PackedRows> Pack(StripView const& strip) override {
        size_t const width = static_cast<size_t>(strip.width),
                     count = static_cast<size_t>(_numChannels);
        size_t const first = static_cast<size_t>(strip.firstRow) * width;
        std::copy_n(strip.coverage, strip.GetTexel(strip.numRows), &_image.coverage[first]);
        for (int row = 0; row < strip.numRows; ++row) {
            float* const to = &_image.texels[(first + strip.GetTexel(row)) * count];
            for (int c = 0; c < _numChannels; ++c) {
                float const* const from = strip.GetRow(c, row);
                for (size_t x = 0; x < width; ++x) to[x * count + static_cast<size_t>(c)] = from[x];
            }
        }
        return std::make_unique<PackedRows>();
    }

    void Write(StripView const&, PackedRows&) override {}

    size_t Commit(BakeOutput&) override {
        _images.push_back(std::move(_image));
        return 0;
    }

private:
    int _numChannels;
    BakedImage _image;
    std::vector<BakedImage>& _images;
};

}  // namespace

std::unique_ptr<TexelSink> MemoryDestination::Open(FileLayout const& file, BakeOutput& output) {
    return std::make_unique<MemorySink>(file, output, _images);
}

}  // namespace limn::engine
