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

/// Posted where something has happened.
sem_t somethingHappened;

/// Safe in a signal handler.
void NoteSignal(int signal) {
    int none = 0;
    firstSignal.compare_exchange_strong(none, signal);
    if (++numSignals == 3) std::_Exit(128 + signal);
    ::sem_post(&somethingHappened);
}

/// Takes blocked signals as they come, until the process ends.
void TakeSignals(sigset_t signals) {
    for (;;) {
        int signal = 0;
        if (::sigwait(&signals, &signal) == 0) NoteSignal(signal);
    }
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

void WatchForSignals() {
    ::sem_init(&somethingHappened, 0, 0);
    sigset_t watched;
    ::sigemptyset(&watched);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        if (std::signal(signal, NoteSignal) == SIG_IGN && signal == SIGHUP)
            std::signal(signal, SIG_IGN);  // nohup has it ignored, which should stay so
        else
            ::sigaddset(&watched, signal);
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // A library may replace a handler while it works, by one that is for its own thread alone.
    // Signals that all threads block, as they inherit it from this one, come to no handler.
    ::pthread_sigmask(SIG_BLOCK, &watched, nullptr);
    try {
        std::thread(TakeSignals, watched).detach();
    } catch (std::system_error const&) {  // there may be no more threads
        ::pthread_sigmask(SIG_UNBLOCK, &watched, nullptr);
    }
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
