// SPDX-License-Identifier: Apache-2.0
#include "support/program/program.h"

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace limn::test {
namespace {

template <class Resource>
void Limit(Resource resource, size_t bytes) {
    rlimit const limit{bytes, bytes};
    if (bytes != 0 && ::setrlimit(resource, &limit) != 0) ::_exit(126);
}

}  // namespace

Process::Process(std::vector<std::string> command, RunOptions const& options) {
    std::string const outPath = options.stdoutPath.empty() ? _streams / "out" : options.stdoutPath;
    std::string const errPath = options.stderrPath.empty() ? _streams / "err" : options.stderrPath;
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

Process::~Process() {
    if (_pid <= 0) return;
    ::kill(_pid, SIGKILL);
    ::waitpid(_pid, nullptr, 0);
}

bool Process::HasEnded() const {
    siginfo_t state{};
    ::waitid(P_PID, static_cast<id_t>(_pid), &state, WEXITED | WNOHANG | WNOWAIT);
    return state.si_pid != 0;
}

double Process::GetProcessorTime() const {
    clockid_t clock = 0;
    timespec time{};
    if (::clock_getcpuclockid(_pid, &clock) == 0) ::clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Outcome Process::Wait() {
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

}  // namespace limn::test
