// SPDX-License-Identifier: Apache-2.0
#include "engine/io/file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace fs = std::filesystem;

void ThrowIoError(std::string const& path, char const* doing) {
    throw Error(ErrorCode::Io, fmt::format("'{}' {}: {}", path, doing, std::strerror(errno)));
}

namespace {

struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
};

}  // namespace

std::string GetEnding(std::string const& path) {
    std::string ending = fs::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

InputFile::InputFile(std::string const& path) {
    Descriptor const file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.fd < 0) ThrowIoError(path, "cannot be opened");
    struct stat status{};
    if (::fstat(file.fd, &status) != 0) ThrowIoError(path, "cannot be read");
    if (S_ISDIR(status.st_mode)) {
        throw Error(ErrorCode::Io, fmt::format("'{}' cannot be read: it is a folder", path));
    }
    size_t capacity = static_cast<size_t>(status.st_size) + 1;
    _data = static_cast<char*>(std::malloc(capacity));
    while (_data) {
        if (_size == capacity) {
            capacity *= 2;
            char* const larger = static_cast<char*>(std::realloc(_data, capacity));
            if (!larger) {
                std::free(_data);
                _data = nullptr;
                break;
            }
            _data = larger;
        }
        ssize_t const count = ::read(file.fd, _data + _size, capacity - _size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            int const reason = errno;
            std::free(_data);
            errno = reason;
            ThrowIoError(path, "cannot be read");
        }
        if (count == 0) return;
        _size += static_cast<size_t>(count);
    }
    throw Error(ErrorCode::TooLarge, fmt::format("'{}' does not fit into memory", path));
}

InputFile::~InputFile() {
    std::free(_data);
}

namespace {

class Sha256Stream {
public:
    Sha256Stream() : _context(EVP_MD_CTX_new()) {
        EVP_DigestInit_ex(_context, EVP_sha256(), nullptr);
    }
    ~Sha256Stream() { EVP_MD_CTX_free(_context); }
    Sha256Stream(Sha256Stream const&) = delete;
    Sha256Stream& operator=(Sha256Stream const&) = delete;

    void Add(void const* data, size_t size) { EVP_DigestUpdate(_context, data, size); }

    std::string Finish() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
        unsigned size = 0;
        EVP_DigestFinal_ex(_context, digest.data(), &size);
        std::string text;
        for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
        return text;
    }

private:
    EVP_MD_CTX* _context;
};

}  // namespace

std::string Sha256(std::string_view bytes) {
    Sha256Stream stream;
    stream.Add(bytes.data(), bytes.size());
    return stream.Finish();
}

std::string Sha256OfFile(std::string const& path) {
    Descriptor const file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.fd < 0) ThrowIoError(path, "cannot be opened");
    Sha256Stream stream;
    std::string buffer(1 << 20, '\0');
    for (;;) {
        ssize_t const count = ::read(file.fd, buffer.data(), buffer.size());
        if (count < 0) ThrowIoError(path, "cannot be read");
        if (count == 0) return stream.Finish();
        stream.Add(buffer.data(), static_cast<size_t>(count));
    }
}

namespace {

std::string HostName() {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) return "localhost";
    return name.data();
}

fs::path FolderOf(std::string const& path) {
    fs::path const folder = fs::path(path).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// Folders that this run has made for its files. Whoever adds or removes a file in one holds the
/// mutex.
std::mutex madeFoldersMutex;
std::set<std::string> madeFolders;

/// Creates the last folder of a path; its parent has to exist.
void PrepareFolder(std::string const& path) {
    fs::path const folder = FolderOf(path);
    std::error_code ignored;
    if (fs::is_directory(folder, ignored)) return;
    if (::mkdir(folder.c_str(), 0777) == 0) {
        madeFolders.insert(folder.string());
        return;
    }
    if (errno == EEXIST) return;
    if (errno == ENOENT) {
        throw Error(ErrorCode::Io,
                    fmt::format("'{}' cannot be written: the folder '{}' does not exist", path,
                                folder.parent_path().string()));
    }
    ThrowIoError(path, "cannot be written");
}

/// Removes a folder that this run has made if it is empty; one with files in it stays.
void RemoveIfMadeAndEmpty(fs::path const& folder) {
    if (madeFolders.contains(folder.string()) && ::rmdir(folder.c_str()) == 0)
        madeFolders.erase(folder.string());
}

/// Removes `.NAME.HOST.PID.tmp` files whose process on this host has ended.
void SweepStaleTemporaries(fs::path const& folder, std::string const& host) {
    static std::mutex mutex;
    static std::set<std::string> swept;  // each folder once per run
    {
        std::lock_guard const lock(mutex);
        if (!swept.insert(folder.string()).second) return;
    }
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::string const name = entry->path().filename().string();
        constexpr std::string_view kEnding = ".tmp";
        if (name.empty() || name[0] != '.' || !name.ends_with(kEnding)) continue;
        size_t const pidBegin = name.rfind('.', name.size() - kEnding.size() - 1);
        if (pidBegin == std::string::npos || pidBegin < host.size() + 1) continue;
        if (name.compare(pidBegin - host.size() - 1, host.size() + 1, "." + host) != 0) continue;
        long const pid = std::strtol(name.c_str() + pidBegin + 1, nullptr, 10);
        if (pid > 0 && ::kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH) {
            std::error_code ignored;
            fs::remove(entry->path(), ignored);
        }
    }
}

}  // namespace

AtomicFile::AtomicFile(std::string const& path) : _path(path) {
    std::lock_guard const lock(madeFoldersMutex);
    PrepareFolder(path);
    fs::path const folder = FolderOf(path);
    std::string const host = HostName();
    SweepStaleTemporaries(folder, host);
    std::string const name =
        fmt::format(".{}.{}.{}.tmp", fs::path(path).filename().string(), host, ::getpid());
    _temporary = (folder / name).string();
    Descriptor const file{
        ::open(_temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
    if (file.fd < 0) {
        int const reason = errno;
        RemoveIfMadeAndEmpty(folder);
        errno = reason;
        ThrowIoError(path, "cannot be written");
    }
}

AtomicFile::~AtomicFile() {
    if (_isCommitted) return;
    std::lock_guard const lock(madeFoldersMutex);
    ::unlink(_temporary.c_str());
    RemoveIfMadeAndEmpty(FolderOf(_path));
}

void AtomicFile::Commit() {
    {
        Descriptor const file{::open(_temporary.c_str(), O_RDONLY | O_CLOEXEC)};
        if (file.fd < 0 || ::fsync(file.fd) != 0) ThrowIoError(_path, "cannot be written");
    }
    if (::rename(_temporary.c_str(), _path.c_str()) != 0) ThrowIoError(_path, "cannot be written");
    _isCommitted = true;
}

void AtomicFile::Write(std::string_view bytes) {
    Descriptor const file{::open(_temporary.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)};
    if (file.fd < 0) ThrowIoError(_path, "cannot be written");
    while (!bytes.empty()) {
        ssize_t const count = ::write(file.fd, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) ThrowIoError(_path, "cannot be written");
        bytes.remove_prefix(static_cast<size_t>(count));
    }
}

void WriteFileAtomically(std::string const& path, std::string_view bytes) {
    AtomicFile output(path);
    output.Write(bytes);
    output.Commit();
}

}  // namespace limn::engine
