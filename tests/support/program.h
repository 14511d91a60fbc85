// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

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
    explicit Process(std::vector<std::string> command, RunOptions const& options = {}) {
        std::string const outPath =
            options.stdoutPath.empty() ? _streams / "out" : options.stdoutPath;
        std::string const errPath =
            options.stderrPath.empty() ? _streams / "err" : options.stderrPath;
        std::vector<char*> arguments;
        for (std::string& word : command) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        _pid = ::fork();
        if (_pid < 0) throw std::runtime_error("cannot fork");
        if (_pid != 0) return;
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(::open(outPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        ::dup2(::open(errPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        for (int stream : options.closed) ::close(stream);
        // A test that runs in the background has SIGINT ignored, which a program would inherit.
        for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_DFL);
        if (options.ignoredSignal != 0) ::signal(options.ignoredSignal, SIG_IGN);
        if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
        Limit(RLIMIT_FSIZE, options.maxFileBytes);
        Limit(RLIMIT_AS, options.maxMemoryBytes);
        for (std::string const& entry : options.environment) ::putenv(::strdup(entry.c_str()));
        ::execv(arguments[0], arguments.data());
        ::_exit(127);
    }
    ~Process() {
        if (_pid <= 0) return;
        ::kill(_pid, SIGKILL);
        ::waitpid(_pid, nullptr, 0);
    }
    Process(Process const&) = delete;
    Process& operator=(Process const&) = delete;

    pid_t GetPid() const { return _pid; }
    void Send(int signal) const { ::kill(_pid, signal); }

    bool HasEnded() const {
        siginfo_t state{};
        ::waitid(P_PID, static_cast<id_t>(_pid), &state, WEXITED | WNOHANG | WNOWAIT);
        return state.si_pid != 0;
    }

    /// So far, in seconds, of all its threads.
    double GetProcessorTime() const {
        clockid_t clock = 0;
        timespec time{};
        if (::clock_getcpuclockid(_pid, &clock) == 0) ::clock_gettime(clock, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    Outcome Wait() {
        int state = 0;
        rusage usage{};
        ::wait4(_pid, &state, 0, &usage);
        _pid = -1;
        Outcome outcome;
        auto const seconds = [](timeval const& time) {
            return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
        };
        outcome.processorSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
        outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state);
        if (std::filesystem::exists(_streams / "err")) outcome.err = ReadText(_streams / "err");
        if (std::filesystem::exists(_streams / "out")) outcome.out = ReadText(_streams / "out");
        return outcome;
    }

private:
    template <class Resource>
    static void Limit(Resource resource, size_t bytes) {
        rlimit const limit{bytes, bytes};
        if (bytes != 0 && ::setrlimit(resource, &limit) != 0) ::_exit(126);
    }

    TemporaryFolder _streams;
    pid_t _pid = -1;
};

}  // namespace limn::test
