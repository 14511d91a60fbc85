// SPDX-License-Identifier: Apache-2.0
#include "engine/io/file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "engine/io/descriptor.h"
#include "engine/scene/sha256.h"
#include "far_ext/error.h"

namespace limn::engine {

void ThrowIoError(std::string const& path, char const* doing) {
    int const reason = errno;  // before anything is allocated, which may change it
    throw Error(ErrorCode::Io, fmt::format("'{}' {}: {}", path, doing, std::strerror(reason)));
}

std::string GetEnding(std::string const& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

namespace {

/// What is typed at a terminal is shorter.
constexpr size_t kMostOfADevice = 1 << 26;

Descriptor OpenToRead(std::string const& path) {
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.IsOpen()) ThrowIoError(path, "cannot be opened");
    return file;
}

/// As read(2), whatever signals come. 0 at the end.
ssize_t ReadSome(Descriptor const& file, char* to, size_t size) {
    ssize_t count = 0;
    do {
        count = ::read(file.Get(), to, size);
    } while (count < 0 && errno == EINTR);
    return count;
}

}  // namespace

InputFile::InputFile(std::string const& path) {
    Descriptor const file = OpenToRead(path);
    struct stat status{};
    if (::fstat(file.Get(), &status) != 0) ThrowIoError(path, "cannot be read");
    if (S_ISDIR(status.st_mode)) {
        throw Error(ErrorCode::Io, fmt::format("'{}' cannot be read: it is a folder", path));
    }
    size_t capacity = static_cast<size_t>(status.st_size) + 1;
    _data.reset(static_cast<char*>(std::malloc(capacity)));
    while (_data) {
        if (_size == capacity) {
            capacity *= 2;
            char* const held = _data.release();
            auto* const larger = static_cast<char*>(std::realloc(held, capacity));
            _data.reset(larger ? larger : held);
            if (!larger) break;
        }
        ssize_t const count = ReadSome(file, _data.get() + _size, capacity - _size);
        if (count < 0) ThrowIoError(path, "cannot be read");
        if (count == 0) return;
        _size += static_cast<size_t>(count);
        if (S_ISCHR(status.st_mode) && _size > kMostOfADevice) {
            throw Error(ErrorCode::Io,
                        fmt::format("'{}' cannot be read: it is a device without an end", path));
        }
    }
    throw std::bad_alloc();
}

void ReadBlocks(std::string const& path, std::function<void(std::string_view)> const& take) {
    Descriptor const file = OpenToRead(path);
    std::string buffer(1 << 20, '\0');
    for (;;) {
        ssize_t const count = ReadSome(file, buffer.data(), buffer.size());
        if (count < 0) ThrowIoError(path, "cannot be read");
        if (count == 0) return;
        take({buffer.data(), static_cast<size_t>(count)});
    }
}

std::string Sha256OfFile(std::string const& path, std::function<void()> const& check) {
    Sha256Stream stream;
    ReadBlocks(path, [&](std::string_view block) {
        if (check) check();
        stream.Add(block);
    });
    return stream.Finish();
}

}  // namespace limn::engine
