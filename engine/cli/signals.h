// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace limn::cli {

/// Opens stdin, stdout and stderr where they are closed, so that no file of limn's gets their
/// numbers: stderr swallows what it gets, stdout refuses it.
void OpenStandardStreams();

/// Notes SIGINT, SIGTERM and SIGHUP, so that the work at hand can stop and leave nothing
/// half-written. A third of them ends the process at once. Writing into what nobody reads, or
/// beyond the limit of a file's size, fails rather than ends it.
/// Called once, before there are other threads.
void WatchForSignals();

/// The exit status that the signal that has come asks for, 128 + its number; 0 if none has.
int GetStopStatus();

/// Runs work() on a thread of its own and waits until it is done or, after a signal, should have
/// stopped long since.
///
/// \return  false if it still runs; it goes on until the process ends
bool RunInterruptibly(std::function<void()> const& work);

}  // namespace limn::cli
