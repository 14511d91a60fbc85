// SPDX-License-Identifier: Apache-2.0
//
// Tiles as EXR's writer compresses them: whatever the bytes and the width, zlib and libdeflate read
// them back, in the room that was given, and every instruction set writes the same.

#include <algorithm>
#include <vector>

#include "engine/images/deflate/tile_deflate.h"
#include "fuzz/choices.h"
#include "fuzz/fuzzer.h"
#include "support/inflate.h"
#include "support/instruction_sets.h"

namespace limn::fuzz {

namespace {

constexpr size_t kMaxSize = 1 << 16;  // beyond what deflate's distances reach

/// Bytes one by one, runs and copies of what came before, so that a short input makes long matches.
std::vector<uint8_t> TakeBytes(Choices& choices, size_t rowSize) {
    std::vector<uint8_t> bytes;
    while (!choices.IsAtEnd() && bytes.size() < kMaxSize) {
        size_t const kind = choices.TakeInt(0, 3);
        if (kind == 0) {
            bytes.push_back(choices.TakeByte());
            continue;
        }
        size_t const count = choices.TakeInt(1, kind == 1 ? 16 : 1024);
        size_t distance = kind == 3 ? rowSize * choices.TakeInt(1, 2) : 0;
        distance += choices.TakeInt(0, 8);
        for (size_t i = 0; i < count; ++i) {
            bool const isCopy = distance > 0 && distance <= bytes.size();
            bytes.push_back(isCopy ? bytes[bytes.size() - distance] : choices.TakeByte());
        }
    }
    return bytes;
}

void CompressAndBack(std::vector<uint8_t> const& bytes, size_t rowSize, size_t room) {
    static engine::TileDeflate deflate;  // what earlier tiles left there must not matter
    std::vector<uint8_t> first;
    test::ForEachInstructionSet([&](eval::InstructionSet) {
        std::copy(bytes.begin(), bytes.end(), deflate.Prepare(bytes.size(), rowSize).begin());
        std::vector<uint8_t> stream(room);
        stream.resize(deflate.Compress(stream));
        if (first.empty()) first = stream;
        Require(stream == first, "every instruction set writes the same bytes");
    });
    Require(!first.empty() || room < 2 * bytes.size() + 64, "a tile fits into twice its size");
    if (first.empty()) return;
    Require(test::InflateByZlib(first, bytes.size()) == bytes, "zlib reads a tile back");
    Require(test::InflateByLibdeflate(first, bytes.size()) == bytes,
            "libdeflate reads a tile back");
}

}  // namespace

}  // namespace limn::fuzz

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size) {
    using namespace limn::fuzz;
    Choices choices({data, size});
    bool const hasRoom = !choices.TakeOneIn(8);
    auto const rowSize = static_cast<size_t>(choices.TakeInt(1, choices.TakeBool() ? 20000 : 256));
    std::vector<uint8_t> const bytes = TakeBytes(choices, rowSize);
    if (!bytes.empty())
        CompressAndBack(bytes, rowSize, hasRoom ? 2 * bytes.size() + 64 : bytes.size());
    return 0;
}
