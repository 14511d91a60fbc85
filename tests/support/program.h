// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <cstdlib>
#include <cstring>
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
};

struct RunOptions {
    std::vector<std::string> environment{};  ///< NAME=VALUE, beside what the test itself has
    std::string folder{};                    ///< to run in; empty for the test's own
    std::string stdoutPath{};                ///< where stdout goes instead of into Outcome::out
    size_t maxFileBytes = 0;                 ///< no file may become larger; 0: any may
};

/// A program that runs beside the test. It is killed if the test ends before it.
class Process {
public:
    explicit Process(std::vector<std::string> command, RunOptions const& options = {}) {
        std::string const outPath =
            options.stdoutPath.empty() ? _streams / "out" : options.stdoutPath;
        std::string const errPath = _streams / "err";
        std::vector<char*> arguments;
        for (std::string& word : command) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        _pid = ::fork();
        if (_pid < 0) throw std::runtime_error("cannot fork");
        if (_pid != 0) return;
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(::open(outPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        ::dup2(::open(errPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
        if (options.maxFileBytes != 0) LimitFiles(options.maxFileBytes);
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

    Outcome Wait() {
        int state = 0;
        ::waitpid(_pid, &state, 0);
        _pid = -1;
        Outcome outcome;
        outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state);
        outcome.err = ReadText(_streams / "err");
        if (std::filesystem::exists(_streams / "out")) outcome.out = ReadText(_streams / "out");
        return outcome;
    }

private:
    /// Writing beyond the limit fails as it does on a full disk, rather than killing the program.
    static void LimitFiles(size_t bytes) {
        rlimit const limit{bytes, bytes};
        ::signal(SIGXFSZ, SIG_IGN);
        if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(126);
    }

    TemporaryFolder _streams;
    pid_t _pid = -1;
};

}  // namespace limn::test
