// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <limits>
#include <string>
#include <vector>

#include "engine/scene/job.h"

namespace limn::test {

/// A host that keeps what it hears, notices if two threads tell it something at once, and stops its
/// job at a chosen question.
struct Listener {
    std::vector<engine::Progress> progress;
    std::vector<std::string> warnings;
    std::atomic<int> numHearing{0};
    bool isAlone = true;
    std::atomic<int> numQuestions{0};
    std::atomic<int> stopAt{std::numeric_limits<int>::max()};  ///< question, from 1

    engine::JobHost MakeHost() {
        return {.onProgress = [this](engine::Progress const& p) { Hear(progress, p); },
                .onWarning = [this](std::string const& text) { Hear(warnings, text); },
                .isStopped = [this] { return ++numQuestions >= stopAt; }};
    }

    template <class T>
    void Hear(std::vector<T>& all, T const& told) {
        if (++numHearing != 1) isAlone = false;
        all.push_back(told);
        --numHearing;
    }
};

/// True if `act(job)` stops wherever half of its questions are answered by a stop.
template <class Act>
bool StopsHalfway(Act act) {
    Listener patient;
    engine::Job whole(patient.MakeHost());
    act(whole);
    Listener hasty;
    hasty.stopAt = (patient.numQuestions + 1) / 2;
    engine::Job half(hasty.MakeHost());
    try {
        act(half);
    } catch (engine::Stopped const&) {
        return patient.numQuestions > 0;
    }
    return false;
}

}  // namespace limn::test
