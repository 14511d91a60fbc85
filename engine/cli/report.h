// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/io/atomic_file.h"

namespace limn::cli {

/// The report of a run, as JSON to a file or stdout. It is filled by the thread that runs the verb,
/// and can be written by another one where that has to be given up.
class Report {
public:
    /// The report, nobody else's while this lives.
    class Access {
    public:
        explicit Access(Report& report) : _lock(report._mutex), _json(report._json) {}

        operator nlohmann::json&() const { return _json; }
        nlohmann::json& operator[](char const* key) const { return _json[key]; }
        nlohmann::json* operator->() const { return &_json; }

    private:
        std::unique_lock<std::timed_mutex> _lock;
        nlohmann::json& _json;
    };

    /// Opens a file before the work, so that a report that cannot be written is known before there
    /// is output. A pipe or device is opened when the report is written: what opens one has to
    /// write to it, and after a usage error there is no report.
    ///
    /// \param path    `-` for stdout; empty for none
    /// \throws Error  Io
    explicit Report(std::string const& path);

    bool IsWanted() const { return !_path.empty(); }

    Access Open() { return Access(*this); }

    /// Writes it with these keys added, once. \throws Error Io
    void Write(nlohmann::json const& more);

    /// As Write, for a process that ends while its threads still work: theirs is no file from now
    /// on (engine::AbandonFiles). Writes nothing where somebody does not let go of the report.
    void WriteAndAbandonFiles(nlohmann::json const& more);

private:
    bool GoesToStdout() const { return _path == "-"; }
    void WriteLocked(nlohmann::json const& more, engine::PipeReader reader);

    std::timed_mutex _mutex;
    nlohmann::json _json;
    bool _isWritten = false;
    std::string _path;
    std::unique_ptr<engine::AtomicFile> _file;
};

}  // namespace limn::cli
