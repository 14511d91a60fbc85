// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include <limn/engine/bake/bake.h>
#include <limn/engine/bake/texel_sink.h>
#include <limn/engine/io/mesh_reader.h>

namespace engine = limn::engine;

// A map as raw 32-bit floats, [row][channel][column].
class RawFile : public engine::TexelSink {
public:
    RawFile(std::string const& path, int numChannels)
        : _path(path), _file(path, std::ios::binary), _numChannels(numChannels) {}
    ~RawFile() override {
        if (_file.is_open()) std::remove(_path.c_str());  // never committed
    }

    bool WantsCoverage() const override { return false; }
    std::unique_ptr<engine::PackedRows> Pack(engine::StripView const&) override {
        return std::make_unique<engine::PackedRows>();  // many threads may compress here
    }
    void Write(engine::StripView const& strip, engine::PackedRows&) override {
        auto const size = static_cast<std::streamsize>(sizeof(float)) * strip.width;
        for (int row = 0; row < strip.numRows; ++row) {
            for (int channel = 0; channel < _numChannels; ++channel)
                _file.write(reinterpret_cast<char const*>(strip.GetRow(channel, row)), size);
        }
    }
    std::size_t Commit(engine::BakeOutput&) override {
        _file.close();
        return 0;  // no value had to be clamped
    }

private:
    std::string _path;
    std::ofstream _file;
    int _numChannels;
};

class RawFiles : public engine::BakeDestination {
    std::unique_ptr<engine::TexelSink> Open(engine::FileLayout const& file,
                                            engine::BakeOutput& output) override {
        output.path = output.map + "." + std::to_string(output.tile) + ".raw";
        return std::make_unique<RawFile>(output.path, file.numPlanes);
    }
};

int main(int argc, char** argv) {
    if (argc != 2) return std::puts("usage: bake_to_sink MESH"), 2;
    engine::Model const model = engine::Model::Build(engine::ReadMesh(argv[1]));

    engine::BakeOptions options;
    options.maps = {"mean", "normal"};
    options.width = options.height = 256;

    RawFiles files;
    engine::Job job;
    engine::BakeReport const report = engine::BakeTo(files, model, options, job);
    for (engine::BakeOutput const& file : report.outputs)
        std::printf("%s: from %.9g to %.9g\n", file.path.c_str(), file.min, file.max);
}
