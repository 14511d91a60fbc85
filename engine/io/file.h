// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace limn::engine {

/// A whole file in memory. Read rather than mapped: a mapped file that shrinks under a running
/// bake would end the process, and pipes cannot be mapped.
class InputFile {
public:
    /// \throws Error  Io, with the system's reason
    explicit InputFile(std::string const& path);
    ~InputFile();
    InputFile(InputFile const&) = delete;
    InputFile& operator=(InputFile const&) = delete;

    std::string_view GetBytes() const { return {_data, _size}; }

private:
    char* _data = nullptr;
    size_t _size = 0;
};

/// A file's ending in small letters, with its dot: ".obj" of "Head.OBJ"; empty without one.
std::string GetEnding(std::string const& path);

/// SHA-256 of bytes, as 64 hexadecimal digits.
std::string Sha256(std::string_view bytes);

/// SHA-256 of a file's bytes. \throws Error Io
std::string Sha256OfFile(std::string const& path);

/// A file that appears complete under its name or not at all: written to `.<name>.<host>.<pid>.tmp`
/// in the same folder, flushed to the disk, then renamed. A writer that dies leaves only its
/// temporary, which the next run on the same host sweeps away.
class AtomicFile {
public:
    /// Creates the last folder of the path where it is missing.
    /// \throws Error  Io: a missing parent folder, no permission, ...
    explicit AtomicFile(std::string const& path);

    /// Unless committed, removes the temporary, and the folder if this run has made it and it is
    /// empty now.
    ~AtomicFile();
    AtomicFile(AtomicFile const&) = delete;
    AtomicFile& operator=(AtomicFile const&) = delete;

    /// Where to write until Commit.
    std::string const& GetTemporaryPath() const { return _temporary; }

    /// Appends bytes. \throws Error Io
    void Write(std::string_view bytes);

    /// Flushes and renames. \throws Error Io
    void Commit();

private:
    std::string _path, _temporary;
    bool _isCommitted = false;
};

/// Writes a whole file through AtomicFile. \throws Error Io
void WriteFileAtomically(std::string const& path, std::string_view bytes);

/// "FILE: cannot be written: No space left on device", from errno.
[[noreturn]] void ThrowIoError(std::string const& path, char const* doing);

}  // namespace limn::engine
