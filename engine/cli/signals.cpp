// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/signals.h"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace limn::cli {

namespace {

std::atomic<int> signalCaught{0};

void OnSignal(int signal) {
    if (signalCaught.exchange(signal) != 0) std::_Exit(128 + signal);
}

}  // namespace

void InstallSignalHandlers() {
    std::signal(SIGINT, OnSignal);
    std::signal(SIGTERM, OnSignal);
    std::signal(SIGPIPE, SIG_IGN);
}

int GetSignal() {
    return signalCaught.load(std::memory_order_relaxed);
}

}  // namespace limn::cli
