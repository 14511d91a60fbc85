// SPDX-License-Identifier: Apache-2.0
//
// Images: finished EXR files as --skip-existing, audits and previews read them, and pictures that
// widths are painted in.

#include <string>
#include <vector>

#include "engine/images/exr_lookup.h"
#include "engine/images/exr_rows.h"
#include "engine/images/exr_writer.h"
#include "engine/images/grey_image.h"
#include "fuzz/fuzzer.h"
#include "fuzz/memory_file.h"

namespace limn::fuzz {

namespace {

void ReadHeader(std::string const& path) {
    for (auto const& [name, value] : engine::ReadExrAttributes(path, "limn:"))
        Require(name.starts_with("limn:"), "only attributes with the prefix are listed");
}

void ReadRows(std::string const& path) {
    engine::ExrRows rows(path, {"Y"});
    rows.GetRow(0, 0);
}

void LookUp(std::string const& path) {
    engine::ExrLookup lookup;
    for (double const at : {0.0, 2.5, 1e3})
        Require(lookup.Look(path, {"Y"}, at, at).size() == 1, "a channel has a value");
}

void ReadPicture(std::string const& path) {
    auto const image = engine::ReadFirstChannel(path);
    Require(
        image.values.size() == static_cast<size_t>(image.width) * static_cast<size_t>(image.height),
        "an image has a value per pixel");
}

}  // namespace

}  // namespace limn::fuzz

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size) {
    using namespace limn::fuzz;
    UseOneThread();
    MemoryFile const file({data, size});
    for (auto* const read : {ReadHeader, ReadRows, LookUp, ReadPicture})
        Succeeds([&] { read(file.GetPath()); });
    return 0;
}
