// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/report.h"

#include <chrono>

#include "engine/cli/console.h"

namespace limn::cli {

Report::Report(std::string const& path) : _goesToStdout(path == "-") {
    if (!path.empty() && !_goesToStdout) _file = std::make_unique<engine::AtomicFile>(path);
}

void Report::Write(nlohmann::json const& more) {
    std::lock_guard const lock(_mutex);
    WriteLocked(more);
}

void Report::WriteAndAbandonFiles(nlohmann::json const& more) {
    std::unique_lock const lock(_mutex, std::chrono::milliseconds(100));
    engine::AbandonFiles(lock ? _file.get() : nullptr);
    if (lock) WriteLocked(more);
}

void Report::WriteLocked(nlohmann::json const& more) {
    if (_isWritten || !IsWanted()) return;
    _isWritten = true;
    _json.update(more);
    std::string const text =
        _json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (_goesToStdout) return PrintData(text);
    _file->Write(text);
    _file->Commit();
}

}  // namespace limn::cli
