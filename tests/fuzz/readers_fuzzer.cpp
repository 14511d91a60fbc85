// SPDX-License-Identifier: Apache-2.0
//
// Meshes: bytes are read as the format they begin like, and what can be built reads back the same
// once it is written.

#include <optional>
#include <span>
#include <string_view>

#include "engine/differential/polyline_file.h"
#include "engine/io/mesh_reader.h"
#include "engine/scene/model.h"
#include "fuzz/fuzzer.h"
#include "fuzz/memory_file.h"
#include "fuzz/same_scene.h"

namespace limn::fuzz {

namespace {

void ReadMesh(std::string_view bytes) {
    std::optional<engine::Model> model;
    if (!Succeeds([&] { model = engine::Model::Build(engine::ParseMesh("input", bytes)); })) return;
    RequireRoundTrips(model->MakeScene());
}

}  // namespace

}  // namespace limn::fuzz

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size) {
    using namespace limn::fuzz;
    std::string_view const text(reinterpret_cast<char const*>(data), size);
    ReadMesh(text);
    if (text.find("\nl") != text.npos) {
        MemoryFile const file({data, size});
        Succeeds([&] { limn::engine::ReadPolylines(file.GetPath()); });
    }
    return 0;
}
