// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace limn::engine {

/// A path without links and detours, as far as it exists.
std::string NormalisePath(std::string const& path);

/// The files of a run before it does anything, to find a file that would be overwritten: by what is
/// written besides, or while it is read. What is no file (a pipe, a device) is nobody's.
class DistinctFiles {
public:
    /// Notes a file that the run reads; it may do so for several reasons.
    ///
    /// \param role    what the user calls it, for messages: "--at"
    /// \throws Error  BadOption: it is written, too
    void AddRead(std::string const& path, std::string const& role);

    /// Notes a file that the run writes. \throws Error BadOption: it is there already
    void AddWritten(std::string const& path, std::string const& role);

private:
    struct Use {
        std::string role;
        bool isWritten;
    };

    void Add(std::string const& path, Use const& use);

    std::map<std::string, Use> _uses;  // per file, without links and detours
};

}  // namespace limn::engine
