// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace limn::engine {

/// A whole file in memory. Read rather than mapped: a mapped file that shrinks under a running
/// bake would end the process, and pipes cannot be mapped.
class InputFile {
public:
    /// \throws Error  Io, with the system's reason, or for a device that does not end
    explicit InputFile(std::string const& path);

    std::string_view GetBytes() const { return {_data.get(), _size}; }

private:
    struct Free {
        void operator()(char* data) const { std::free(data); }
    };
    std::unique_ptr<char, Free> _data;
    size_t _size = 0;
};

/// Hands out a file's bytes in order, at most a mebibyte at a time. What `take` throws ends it.
///
/// \throws Error  Io, with the system's reason
void ReadBlocks(std::string const& path, std::function<void(std::string_view)> const& take);

/// SHA-256 of a file's bytes, as 64 hexadecimal digits.
///
/// \param check  called now and then; what it throws ends the work
/// \throws Error Io
std::string Sha256OfFile(std::string const& path, std::function<void()> const& check = {});

/// A file's ending in small letters, with its dot: ".obj" of "Head.OBJ"; empty without one.
std::string GetEnding(std::string const& path);

/// "FILE cannot be written: No space left on device", from errno.
[[noreturn]] void ThrowIoError(std::string const& path, char const* doing);

}  // namespace limn::engine
