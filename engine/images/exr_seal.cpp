// SPDX-License-Identifier: Apache-2.0
#include "engine/images/exr_seal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <fcntl.h>

#include "engine/io/descriptor.h"
#include "engine/io/file.h"
#include "engine/scene/sha256.h"

namespace limn::engine {

namespace {

static_assert(std::endian::native == std::endian::little, "EXR's numbers are read as they stand");

/// Bytes of a file from `offset` on, as many as there are.
std::string ReadAt(Descriptor const& file, off_t offset, size_t size) {
    std::string bytes(size, '\0');
    ssize_t const count = ::pread(file.Get(), bytes.data(), size, offset);
    bytes.resize(static_cast<size_t>(std::max<ssize_t>(count, 0)));
    return bytes;
}

/// Where the values of the two attributes are.
struct Places {
    off_t range = 0, seal = 0;

    bool AreKnown() const { return range != 0 && seal != 0; }
};

/// Walks through the header: attributes, each `NAME\0TYPE\0SIZE` and a value, up to an empty name.
Places FindPlaces(Descriptor const& file) {
    constexpr size_t kMaxHead = 2 * 256 + 4;  // of an attribute, with long names
    Places places;
    off_t offset = 8;  // magic number and version
    for (;;) {
        std::string const head = ReadAt(file, offset, kMaxHead);
        size_t const typeAt = head.find('\0') + 1;
        size_t const sizeAt = head.find('\0', typeAt) + 1;
        // find's npos + 1 is 0
        if (typeAt <= 1 || sizeAt == 0 || head.size() < sizeAt + 4) return places;
        int32_t size = 0;
        std::memcpy(&size, &head[sizeAt], sizeof size);
        if (size < 0) return places;
        offset += static_cast<off_t>(sizeAt + 4);
        std::string_view const what(head.data(), sizeAt);
        using namespace std::string_view_literals;
        if (what == "limn:range\0v2f\0"sv && size == sizeof(ValueRange)) places.range = offset;
        if (what == "limn:sha256\0string\0"sv && size == 64) places.seal = offset;
        offset += size;
    }
}

/// SHA-256 of the file with zeros for digits in the place of the seal.
std::string HashUnsealed(std::string const& path, off_t seal, std::function<void()> const& check) {
    Sha256Stream stream;
    auto const begin = static_cast<size_t>(seal), end = begin + kBlankSeal.size();
    size_t at = 0;
    ReadBlocks(path, [&](std::string_view block) {
        if (check) check();
        size_t const before = std::clamp(begin, at, at + block.size()) - at;
        size_t const after = std::clamp(end, at, at + block.size()) - at;
        stream.Add(block.substr(0, before));
        stream.Add(std::string_view(kBlankSeal).substr(0, after - before));
        stream.Add(block.substr(after));
        at += block.size();
    });
    return stream.Finish();
}

void WriteAt(Descriptor const& file, std::string const& path, off_t offset, void const* bytes,
             size_t size) {
    if (::pwrite(file.Get(), bytes, size, offset) != static_cast<ssize_t>(size))
        ThrowIoError(path, "cannot be written");
}

}  // namespace

void SealExr(std::string const& path, ValueRange const& range, std::function<void()> const& check) {
    Descriptor const file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
    if (!file.IsOpen()) ThrowIoError(path, "cannot be written");
    Places const places = FindPlaces(file);
    WriteAt(file, path, places.range, &range, sizeof range);
    std::string const seal = HashUnsealed(path, places.seal, check);
    WriteAt(file, path, places.seal, seal.data(), seal.size());
}

std::optional<ValueRange> CheckSeal(std::string const& path, std::function<void()> const& check) {
    Descriptor const file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.IsOpen()) return {};
    Places const places = FindPlaces(file);
    if (!places.AreKnown()) return {};
    std::string const seal = ReadAt(file, places.seal, kBlankSeal.size());
    std::string const range = ReadAt(file, places.range, sizeof(ValueRange));
    if (range.size() != sizeof(ValueRange) || HashUnsealed(path, places.seal, check) != seal)
        return {};
    ValueRange found;
    std::memcpy(&found, range.data(), sizeof found);
    return found;
}

}  // namespace limn::engine
