// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/signals.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <semaphore.h>
#include <unistd.h>

namespace limn::cli {

namespace {

using std::chrono::milliseconds;

std::atomic<int> firstSignal{0}, numSignals{0};

/// Posted where something has happened; a signal handler may do that, too.
sem_t somethingHappened;

void OnSignal(int signal) {
    int none = 0;
    firstSignal.compare_exchange_strong(none, signal);
    if (++numSignals == 3) std::_Exit(128 + signal);
    ::sem_post(&somethingHappened);
}

/// Processor time of all threads.
std::chrono::nanoseconds GetProcessorTime() {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

/// Until something happens or a hundredth of a second has gone by.
void WaitShortly() {
    timespec until{};
    ::clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += std::chrono::nanoseconds(milliseconds(10)).count();
    if (until.tv_nsec >= 1'000'000'000) {
        until.tv_nsec -= 1'000'000'000;
        ++until.tv_sec;
    }
    ::sem_timedwait(&somethingHappened, &until);
}

/// Waits for work that was asked to stop. A verb has a second of processor time for ending, of
/// which the system may need most for taking back gigabytes of memory (0.1 s each); the work gets a
/// tenth. One that waits, for a pipe say, gets a second by the clock. Whoever asks twice does not
/// want to wait.
void WaitForStop(std::atomic<bool> const& isDone) {
    auto const start = std::chrono::steady_clock::now();
    auto const spent = GetProcessorTime();
    while (!isDone && numSignals < 2 && GetProcessorTime() - spent < milliseconds(100) &&
           std::chrono::steady_clock::now() - start < std::chrono::seconds(1))
        WaitShortly();
}

}  // namespace

void OpenStandardStreams() {
    for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) >= 0) continue;
        // The lowest number that is free is this one.
        ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    }
}

void InstallSignalHandlers() {
    ::sem_init(&somethingHappened, 0, 0);
    std::signal(SIGINT, OnSignal);
    std::signal(SIGTERM, OnSignal);
    // nohup has it ignored, which should stay so.
    if (std::signal(SIGHUP, OnSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

int GetStopStatus() {
    int const signal = firstSignal.load(std::memory_order_relaxed);
    return signal == 0 ? 0 : 128 + signal;
}

bool RunInterruptibly(std::function<void()> const& work) {
    static std::atomic<bool> isDone{false};  // static: the thread may outlive this call
    std::thread thread;
    try {
        thread = std::thread([work] {
            work();
            isDone = true;
            ::sem_post(&somethingHappened);
        });
    } catch (std::system_error const&) {  // there may be no more threads
        work();
        return true;
    }
    while (!isDone && GetStopStatus() == 0) ::sem_wait(&somethingHappened);
    WaitForStop(isDone);
    bool const isInTime = isDone;
    isInTime ? thread.join() : thread.detach();
    return isInTime;
}

}  // namespace limn::cli
