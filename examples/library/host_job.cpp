// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>

#include <limn/engine/bake/bake.h>
#include <limn/engine/io/mesh_reader.h>
#include <limn/far_ext/error.h>

namespace engine = limn::engine;

int main(int argc, char** argv) {
    if (argc != 3) return std::puts("usage: host_job MESH SECONDS"), 2;
    std::chrono::duration<double> const patience(std::atof(argv[2]));
    std::atomic<bool> isLate = false;
    engine::Job job({.onProgress =
                         [](engine::Progress const& now) {
                             std::printf("%s: %zu of %zu\n", now.phase.c_str(), now.done,
                                         now.total);
                         },
                     .onWarning = [](std::string const& text) { std::puts(text.c_str()); },
                     .isStopped = [&] { return isLate.load(); }});
    try {
        engine::Model const model = engine::Model::Build(engine::ReadMesh(argv[1]));
        engine::BakeOptions options;
        options.maps = {"mean"};
        auto bake =
            std::async(std::launch::async, engine::BakeToMemory, model, options, std::ref(job));
        isLate = bake.wait_for(patience) == std::future_status::timeout;
        std::printf("%zu texels are covered\n", bake.get().report.texelsCovered);
    } catch (engine::Stopped const&) {
        std::puts("stopped");
    } catch (limn::Error const& error) {
        return std::puts(error.what()), error.GetCode() == limn::ErrorCode::Io ? 5 : 3;
    }
}
