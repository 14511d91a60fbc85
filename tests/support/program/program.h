// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include <sys/types.h>

#include "support/files.h"

namespace limn::test {

/// What a program left behind. `status` is its exit status, or -N where signal N killed it.
struct Outcome {
    int status = -1;
    std::string out, err;
    double processorSeconds = 0.0;  ///< of all its threads, the system's share included
};

struct RunOptions {
    std::vector<std::string> environment{};  ///< NAME=VALUE, beside what the test itself has
    std::string folder{};                    ///< to run in; empty for the test's own
    std::string stdoutPath{};                ///< where stdout goes instead of into Outcome::out
    std::string stderrPath{};                ///< likewise
    std::vector<int> closed{};               ///< standard streams that it starts without
    size_t maxFileBytes = 0;                 ///< no file may become larger; 0: any may
    size_t maxMemoryBytes = 0;               ///< of its address space; 0: any amount
    int ignoredSignal = 0;                   ///< as nohup ignores SIGHUP; 0: none
};

/// A program that runs beside the test. It is killed if the test ends before it.
class Process {
public:
    explicit Process(std::vector<std::string> command, RunOptions const& options = {});
    ~Process();
    Process(Process const&) = delete;
    Process& operator=(Process const&) = delete;

    pid_t GetPid() const { return _pid; }
    void Send(int signal) const { ::kill(_pid, signal); }

    bool HasEnded() const;

    /// So far, in seconds, of all its threads.
    double GetProcessorTime() const;

    Outcome Wait();

private:
    TemporaryFolder _streams;
    pid_t _pid = -1;
};

}  // namespace limn::test
