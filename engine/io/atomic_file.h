// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/descriptor.h"

namespace limn::engine {

/// What an output's path leads to, links followed.
enum class OutputKind {
    File,   ///< a file, there already or not yet
    Null,   ///< /dev/null
    Stream  ///< another device, a pipe, a socket, or a descriptor as /dev/stdout is one
};

OutputKind FindOutputKind(std::string const& path);

/// What to do where an output is a pipe that nobody reads yet.
enum class PipeReader { AwaitedForEver, MustBeThere };

/// A file that appears complete under its name or not at all: written to a temporary in the same
/// folder, flushed to the disk, then renamed. Where the path is a link, the file that it leads to
/// appears, and the link stays. What is no file is never replaced: bytes go through it as they
/// come.
///
/// The temporary is called `.NAME.NONCE.tmp`, of NAME at most 200 bytes and NONCE 128 random bits,
/// and is locked (flock) while somebody writes it. So writers of the same file, on whatever
/// machines, never meet; the last one to commit wins. One that is killed leaves its temporary,
/// which nobody else removes.
///
/// Threads  one at a time for each file; any for different ones.
class AtomicFile {
public:
    /// Makes all folders of the path that are missing.
    ///
    /// \throws Error  Io: no permission, the path is a folder, a name beyond 255 bytes, ...
    explicit AtomicFile(std::string const& path, PipeReader reader = PipeReader::AwaitedForEver);

    /// Unless committed, removes the temporary, and the folders that this process has made for it
    /// and that are empty now.
    ~AtomicFile();
    AtomicFile(AtomicFile const&) = delete;
    AtomicFile& operator=(AtomicFile const&) = delete;

    std::string const& GetPath() const { return _path; }

    /// Where to write until Commit, for those who write by path: the temporary or, for what is no
    /// file, the path itself.
    std::string const& GetPathToWrite() const { return _pathToWrite; }

    /// False where bytes go through at once.
    bool IsTemporary() const { return !_target.empty(); }

    /// Appends bytes. \throws Error Io
    void Write(std::string_view bytes);

    /// Flushes to the disk and closes: nothing more is to be written. For those who have many
    /// files, more than a process may have open, before they commit them. \throws Error Io
    void Finish();

    /// Finishes and renames. \throws Error Io
    void Commit();

private:
    friend void CommitTogether(std::span<std::unique_ptr<AtomicFile> const> files);
    friend void AbandonFiles(AtomicFile const* kept);

    void OpenTemporary();
    void Rename();
    void Remove();

    std::string _path, _target, _pathToWrite;  // target: what is renamed to; empty for no file
    Descriptor _file;
    bool _isCommitted = false;
};

/// Finishes all of them, then renames all.
///
/// \throws Error  Io; then none of them is left
void CommitTogether(std::span<std::unique_ptr<AtomicFile> const> files);

/// Writes a whole file through AtomicFile. \throws Error Io
void WriteFileAtomically(std::string const& path, std::string_view bytes);

/// For a process that has to end while other threads still write: removes the temporaries of all
/// files but `kept` (may be null). From now on only the calling thread can open or commit files;
/// others wait for ever.
void AbandonFiles(AtomicFile const* kept);

/// Temporaries of a folder that nobody writes any more and that were last written before `time` on
/// the folder's clock, sorted by name.
std::vector<std::string> FindLeftTemporaries(std::string const& folder,
                                             std::chrono::sys_seconds time);

}  // namespace limn::engine
