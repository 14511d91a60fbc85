// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <libdeflate.h>
#include <zlib.h>

namespace limn::test {

/// What zlib makes of one of its streams that stands for `size` bytes; nothing if it refuses, finds
/// another number, or finds more behind the end.
inline std::vector<uint8_t> InflateByZlib(std::span<uint8_t const> stream, size_t size) {
    std::vector<uint8_t> bytes(size + 1);  // where one too many would go
    uLongf found = bytes.size();
    uLong read = stream.size();
    if (uncompress2(bytes.data(), &found, stream.data(), &read) != Z_OK || found != size ||
        read != stream.size())
        return {};
    bytes.resize(size);
    return bytes;
}

/// The same by libdeflate.
inline std::vector<uint8_t> InflateByLibdeflate(std::span<uint8_t const> stream, size_t size) {
    std::vector<uint8_t> bytes(size);
    libdeflate_decompressor* const decompressor = libdeflate_alloc_decompressor();
    size_t read = 0;
    libdeflate_result const result = libdeflate_zlib_decompress_ex(
        decompressor, stream.data(), stream.size(), bytes.data(), size, &read, nullptr);
    libdeflate_free_decompressor(decompressor);
    if (result != LIBDEFLATE_SUCCESS || read != stream.size()) return {};
    return bytes;
}

}  // namespace limn::test
