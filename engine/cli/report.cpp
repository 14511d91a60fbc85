// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/report.h"

#include <chrono>

#include <unistd.h>

#include "engine/cli/console.h"
#include "engine/io/file.h"

namespace limn::cli {

Report::Report(std::string const& path) : _path(path) {
    if (!IsWanted() || GoesToStdout()) return;
    if (engine::FindOutputKind(path) != engine::OutputKind::Stream)
        _file = std::make_unique<engine::AtomicFile>(path);
    else if (::access(path.c_str(), W_OK) != 0)
        engine::ThrowIoError(path, "cannot be written");
}

void Report::Write(nlohmann::json const& more) {
    std::lock_guard const lock(_mutex);
    WriteLocked(more, engine::PipeReader::AwaitedForEver);
}

void Report::WriteAndAbandonFiles(nlohmann::json const& more) {
    std::unique_lock const lock(_mutex, std::chrono::milliseconds(100));
    engine::AbandonFiles(lock ? _file.get() : nullptr);
    if (lock) WriteLocked(more, engine::PipeReader::MustBeThere);
}

void Report::WriteLocked(nlohmann::json const& more, engine::PipeReader reader) {
    if (_isWritten || !IsWanted()) return;
    _isWritten = true;
    _json.update(more);
    std::string const text =
        _json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (GoesToStdout()) return PrintData(text);
    if (!_file) _file = std::make_unique<engine::AtomicFile>(_path, reader);
    _file->Write(text);
    _file->Commit();
}

}  // namespace limn::cli
