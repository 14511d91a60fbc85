// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::cli {

/// Notes SIGINT and SIGTERM, so that the job at hand can stop and leave nothing half-written. A
/// second signal ends the process at once.
void InstallSignalHandlers();

/// The signal that has come; 0 if none has.
int GetSignal();

}  // namespace limn::cli
