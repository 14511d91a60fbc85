// SPDX-License-Identifier: Apache-2.0
//
// Images: finished EXR files as --skip-existing looks at them, and, where those are whole by their
// header, as audits and pictures read them. What a header claims OpenEXR's own readers may believe.

#include <string>
#include <vector>

#include "engine/images/exr_lookup.h"
#include "engine/images/exr_rows.h"
#include "engine/images/exr_seal.h"
#include "engine/images/exr_writer.h"
#include "engine/images/grey_image.h"
#include "fuzz/fuzzer.h"
#include "fuzz/memory_file.h"

namespace limn::fuzz {

namespace {

/// True if the header can be read, and all chunks that it speaks of are there.
bool ReadHeader(std::string const& path) {
    for (auto const& [name, value] : engine::ReadExrAttributes(path, "limn:"))
        Require(name.starts_with("limn:"), "only attributes with the prefix are listed");
    return !engine::ReadExrAttributes(path, "").empty();
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
    Succeeds([&] { limn::engine::CheckSeal(file.GetPath()); });
    bool isWhole = false;
    Succeeds([&] { isWhole = ReadHeader(file.GetPath()); });
    if (!isWhole) return 0;
    for (auto* const read : {ReadRows, LookUp, ReadPicture})
        Succeeds([&] { read(file.GetPath()); });
    return 0;
}
