// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace limn::fuzz {

/// A file in memory, for what reads by path. It has no name in any folder, and goes with its owner.
class MemoryFile {
public:
    explicit MemoryFile(std::span<uint8_t const> bytes) : _descriptor(::memfd_create("input", 0)) {
        if (_descriptor < 0) throw std::runtime_error("no file in memory");
        _path = "/proc/self/fd/" + std::to_string(_descriptor);
        while (!bytes.empty()) {
            ssize_t const written = ::write(_descriptor, bytes.data(), bytes.size());
            if (written < 0) throw std::runtime_error("a file in memory cannot be written");
            bytes = bytes.subspan(static_cast<size_t>(written));
        }
    }
    ~MemoryFile() { ::close(_descriptor); }
    MemoryFile(MemoryFile const&) = delete;
    MemoryFile& operator=(MemoryFile const&) = delete;

    std::string const& GetPath() const { return _path; }

private:
    int _descriptor;
    std::string _path;
};

}  // namespace limn::fuzz
