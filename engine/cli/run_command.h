// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/io/mesh_source.h"

namespace limn::cli {

/// Exit statuses that a caller may want to tell apart.
inline constexpr int kDone = 0, kNotReached = 4, kStopped = 130;

/// Runs one command: `limn ARGUMENTS`. Data goes to stdout, all else to stderr. Nothing of it
/// outlasts the call or is shared with another one.
///
/// Threads  the caller's and as many of TBB's as the options ask for.
/// \param isStopped  asked often and from many threads at once whether to stop; may be empty
/// \return           the exit status; kStopped where it stopped, and nothing half-written is left
int RunCommand(std::vector<std::string> const& arguments, engine::MeshSource& meshes,
               std::function<bool()> const& isStopped = {});

}  // namespace limn::cli
