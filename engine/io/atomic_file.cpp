// SPDX-License-Identifier: Apache-2.0
#include "engine/io/atomic_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace fs = std::filesystem;

namespace {

// ---- What a path leads to

/// Links of /proc lead to open descriptors, whatever path they claim.
bool IsInProc(fs::path const& link) {
    std::error_code ignored;
    fs::path const folder = fs::canonical(link.parent_path(), ignored);
    return folder.string().starts_with("/proc/");
}

/// The file that a path leads to, there already or not yet; none where it leads elsewhere.
std::optional<fs::path> FindFile(std::string const& path) {
    struct stat status{};
    if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
        return {};
    fs::path file = path;
    constexpr int kMaxLinks = 40;  // as the system's
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(file, error)); ++i) {
        if (IsInProc(file)) return {};
        file = file.parent_path() / fs::read_symlink(file, error);  // which may be absolute
    }
    return file;
}

/// The number of a descriptor of this process that a path leads to.
std::optional<int> FindOwnDescriptor(std::string const& path) {
    fs::path link = path;
    std::error_code error;
    while (fs::is_symlink(fs::symlink_status(link, error)) && !IsInProc(link))
        link = link.parent_path() / fs::read_symlink(link, error);
    fs::path const own = fs::canonical("/proc/self/fd", error);
    if (error || fs::canonical(link.parent_path(), error) != own) return {};
    return std::atoi(link.filename().c_str());
}

/// Opens what is no file. A descriptor of this process is shared rather than opened anew, so that
/// it goes on where it is, and appends if it does.
Descriptor OpenStream(std::string const& path, PipeReader reader) {
    if (auto const number = FindOwnDescriptor(path))
        return Descriptor(::fcntl(*number, F_DUPFD_CLOEXEC, 3));
    int const whether = reader == PipeReader::MustBeThere ? O_NONBLOCK : 0;
    Descriptor stream(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | whether));
    if (stream.IsOpen() && whether != 0) {  // for the opening alone
        int const flags = ::fcntl(stream.Get(), F_GETFL);
        ::fcntl(stream.Get(), F_SETFL, flags & ~O_NONBLOCK);
    }
    return stream;
}

// ---- Temporaries

constexpr size_t kNonceDigits = 32;
constexpr std::string_view kEnding = ".tmp";

std::string MakeNonce() {
    std::array<unsigned char, kNonceDigits / 2> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw std::system_error(errno, std::generic_category(), "no random numbers");
    std::string text;
    for (unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

fs::path MakeTemporaryPath(fs::path const& target) {
    constexpr size_t kMaxName = 200;  // with what follows below the 255 bytes that a name may have
    std::string const name = target.filename().string().substr(0, kMaxName);
    return target.parent_path() / fmt::format(".{}.{}{}", name, MakeNonce(), kEnding);
}

/// True for names as MakeTemporaryPath makes them.
bool IsTemporaryName(std::string_view name) {
    if (!name.starts_with('.') || !name.ends_with(kEnding)) return false;
    name.remove_suffix(kEnding.size());
    size_t const dot = name.rfind('.');
    std::string_view const nonce = name.substr(dot + 1);
    return dot > 0 && nonce.size() == kNonceDigits &&
           nonce.find_first_not_of("0123456789abcdef") == nonce.npos;
}

bool IsLocked(std::string const& path) {
    Descriptor const file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    return file.IsOpen() && ::flock(file.Get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

// ---- What this process has under way

/// Held by whoever adds a file to a folder or takes one away. Recursive for AbandonFiles, whose
/// thread keeps it to the end of the process.
std::recursive_mutex& GetMutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

/// Files with a temporary.
std::set<AtomicFile*>& GetOpenFiles() {
    static std::set<AtomicFile*> files;
    return files;
}

/// Folders that this process has made for its files.
std::set<fs::path>& GetMadeFolders() {
    static std::set<fs::path> folders;
    return folders;
}

fs::path FolderOf(fs::path const& file) {
    fs::path const folder = file.parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// Removes a folder and those above it, as far as this process has made them and they are empty.
void RemoveMadeFolders(fs::path folder) {
    auto& made = GetMadeFolders();
    std::error_code ignored;
    while (FolderOf(folder) != folder && !fs::exists(folder, ignored)) folder = FolderOf(folder);
    while (made.contains(folder) && ::rmdir(folder.c_str()) == 0) {
        made.erase(folder);
        folder = FolderOf(folder);
    }
}

/// \return false, with errno, where it cannot be made
bool MakeFolder(fs::path const& folder) {
    if (::mkdir(folder.c_str(), 0777) != 0) return errno == EEXIST;
    GetMadeFolders().insert(folder);
    return true;
}

/// \return false, with errno, where one cannot be made
bool MakeFolders(fs::path const& folder) {
    std::error_code ignored;
    if (fs::is_directory(folder, ignored) || MakeFolder(folder)) return true;
    return errno == ENOENT && FolderOf(folder) != folder && MakeFolders(FolderOf(folder)) &&
           MakeFolder(folder);
}

}  // namespace

OutputKind FindOutputKind(std::string const& path) {
    if (FindFile(path)) return OutputKind::File;
    struct stat status{};
    bool const isNull = ::stat(path.c_str(), &status) == 0 && S_ISCHR(status.st_mode) &&
                        status.st_rdev == ::makedev(1, 3);
    return isNull ? OutputKind::Null : OutputKind::Stream;
}

AtomicFile::AtomicFile(std::string const& path, PipeReader reader)
    : _path(path), _pathToWrite(path) {
    if (path.find('\0') != path.npos) {  // where the system would end the name
        throw Error(ErrorCode::Io,
                    fmt::format("'{}' cannot be written: a name holds no zero byte", path));
    }
    if (auto const file = FindFile(path)) {
        _target = file->string();
        OpenTemporary();
    } else {
        _file = OpenStream(path, reader);
    }
    if (!_file.IsOpen()) ThrowIoError(path, "cannot be written");
}

/// Leaves a descriptor that is not open, with errno, where that fails.
void AtomicFile::OpenTemporary() {
    std::error_code ignored;
    std::string const name = fs::path(_target).filename();
    errno = name.empty() || fs::is_directory(_target, ignored) ? EISDIR
            : fs::is_symlink(_target, ignored)                 ? ELOOP
            : name.size() > NAME_MAX                           ? ENAMETOOLONG
                                                               : 0;
    if (errno != 0) return;
    std::lock_guard const lock(GetMutex());
    fs::path const folder = FolderOf(_target);
    _pathToWrite = MakeTemporaryPath(_target).string();
    // Again where another process, that made a folder, too, has just removed it.
    for (int attempt = 0; attempt < 3 && !_file.IsOpen(); ++attempt) {
        if (MakeFolders(folder)) {
            _file = Descriptor(
                ::open(_pathToWrite.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        }
        if (!_file.IsOpen() && errno != ENOENT) break;
    }
    if (!_file.IsOpen()) {
        int const reason = errno;
        RemoveMadeFolders(folder);
        errno = reason;
        return;
    }
    // Where a file system has no locks, nobody will find this one locked, and only say so.
    ::flock(_file.Get(), LOCK_EX | LOCK_NB);
    GetOpenFiles().insert(this);
}

AtomicFile::~AtomicFile() {
    if (_isCommitted || !IsTemporary()) return;
    std::lock_guard const lock(GetMutex());
    Remove();
}

void AtomicFile::Remove() {
    ::unlink(_isCommitted ? _target.c_str() : _pathToWrite.c_str());
    RemoveMadeFolders(FolderOf(_target));
    GetOpenFiles().erase(this);
}

void AtomicFile::Write(std::string_view bytes) {
    while (!bytes.empty()) {
        ssize_t const count = ::write(_file.Get(), bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) ThrowIoError(_path, "cannot be written");
        bytes.remove_prefix(static_cast<size_t>(count));
    }
}

void AtomicFile::Finish() {
    if (!_file.IsOpen()) return;
    if (IsTemporary() && ::fsync(_file.Get()) != 0) ThrowIoError(_path, "cannot be written");
    _file = Descriptor();
}

void AtomicFile::Rename() {
    if (!IsTemporary()) return;
    std::lock_guard const lock(GetMutex());
    if (::rename(_pathToWrite.c_str(), _target.c_str()) != 0)
        ThrowIoError(_path, "cannot be written");
    GetOpenFiles().erase(this);
    _isCommitted = true;
}

void AtomicFile::Commit() {
    Finish();
    Rename();
}

void CommitTogether(std::span<std::unique_ptr<AtomicFile> const> files) {
    for (auto const& file : files) file->Finish();
    std::lock_guard const lock(GetMutex());
    try {
        for (auto const& file : files) file->Rename();
    } catch (...) {
        for (auto const& file : files) {
            if (file->_isCommitted) file->Remove();
        }
        throw;
    }
}

void WriteFileAtomically(std::string const& path, std::string_view bytes) {
    AtomicFile output(path);
    output.Write(bytes);
    output.Commit();
}

void AbandonFiles(AtomicFile const* kept) {
    GetMutex().lock();
    auto const files = GetOpenFiles();
    for (AtomicFile* const file : files) {
        if (file != kept) file->Remove();
    }
}

std::vector<std::string> FindLeftTemporaries(std::string const& folder,
                                             std::chrono::sys_seconds time) {
    std::vector<std::string> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::string const path = entry->path().string();
        struct stat status{};
        if (IsTemporaryName(entry->path().filename().string()) &&
            ::lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
            status.st_mtime < time.time_since_epoch().count() && !IsLocked(path))
            found.push_back(path);
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace limn::engine
