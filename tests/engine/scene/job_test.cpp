// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/job.h"

#include <future>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "support/listener.h"

namespace limn {
namespace {

using engine::Job;
using engine::Progress;
using test::Listener;

/// Runs `work` on several threads at once and waits for all.
template <class Work>
void OnThreads(int numThreads, Work work) {
    std::vector<std::jthread> threads;
    for (int i = 0; i < numThreads; ++i) threads.emplace_back([&work, i] { work(i); });
}

TEST(Job, WithoutAHostKeepsWarningsAndNeverStops) {
    Job job;
    job.Start("baking", 2);
    job.Advance(2);
    job.Finish();
    job.Warn("a seam");
    EXPECT_EQ(job.GetWarnings(), std::vector<std::string>{"a seam"});
    EXPECT_NO_THROW(job.CheckStopped());
}

TEST(Job, TellsStartAndEndOfAPhase) {
    Listener listener;
    Job job(listener.MakeHost());
    job.Start("fitting", 3);
    job.Advance();
    job.Finish();
    ASSERT_EQ(listener.progress.size(), 2u);  // the step between follows too soon to be told
    Progress const &first = listener.progress[0], &last = listener.progress[1];
    EXPECT_EQ(first.phase, "fitting");
    EXPECT_EQ(first.done, 0u);
    EXPECT_EQ(first.total, 3u);
    EXPECT_FALSE(first.isFinished);
    EXPECT_EQ(last.done, 3u);
    EXPECT_TRUE(last.isFinished);
}

TEST(Job, TellsPhasesAndNotesInTheOrderOfTheWork) {
    std::vector<std::string> heard;
    auto const hear = [&](std::string const& text) { heard.push_back(text); };
    Job job({.onPhase = hear, .onNote = hear});
    job.Start("reading");
    job.Start("baking", 2);
    job.Note("tile 1001");
    job.Finish();
    job.Start("writing");
    EXPECT_EQ(heard, (std::vector<std::string>{"reading", "baking", "tile 1001", "writing"}));
}

TEST(Job, TellsNoProgressOfAPhaseWithoutSteps) {
    Listener listener;
    Job job(listener.MakeHost());
    job.Start("reading");
    EXPECT_TRUE(listener.progress.empty());
}

TEST(Job, TellsProgressOfManyThreadsForwardOnlyAndAtMostTwentyTimesASecond) {
    Listener listener;
    Job job(listener.MakeHost());
    auto const start = std::chrono::steady_clock::now();
    job.Start("baking", 4 * 300);
    OnThreads(4, [&](int) {
        for (int step = 0; step < 300; ++step) {
            job.Advance();
            std::this_thread::sleep_for(std::chrono::microseconds(500));
        }
    });
    auto const elapsed = std::chrono::steady_clock::now() - start;
    job.Finish();
    EXPECT_TRUE(listener.isAlone);
    EXPECT_GE(listener.progress.size(), 3u);  // 150 ms at least
    EXPECT_LE(listener.progress.size(),
              2u + static_cast<size_t>(elapsed / std::chrono::milliseconds(50)));
    for (size_t i = 1; i < listener.progress.size(); ++i)
        EXPECT_GE(listener.progress[i].done, listener.progress[i - 1].done);
}

TEST(Job, TellsWarningsOneByOneInTheOrderOfTheReport) {
    Listener listener;
    Job job(listener.MakeHost());
    OnThreads(8, [&](int thread) {
        for (int i = 0; i < 100; ++i)
            job.Warn(std::to_string(thread) + " found " + std::to_string(i));
    });
    EXPECT_TRUE(listener.isAlone);
    EXPECT_EQ(listener.warnings.size(), 800u);
    EXPECT_EQ(listener.warnings, job.GetWarnings());
}

TEST(Job, GivesItsWarningsWhileTheHostIsHearing) {
    std::promise<void> isHearing, mayReturn;
    Job job({.onWarning = [&](std::string const&) {
        isHearing.set_value();
        mayReturn.get_future().wait();
    }});
    std::jthread const worker([&] { job.Warn("a seam"); });
    isHearing.get_future().wait();
    EXPECT_EQ(job.GetWarnings().size(), 1u);  // hangs if it waits for the host
    mayReturn.set_value();
}

TEST(Job, StopsWhenItsOwnHostAsksAndNotWhenAnothersDoes) {
    std::atomic<bool> stopOne{false}, stopOther{false};
    Job const one({.isStopped = [&] { return stopOne.load(); }});
    Job const other({.isStopped = [&] { return stopOther.load(); }});
    stopOne = true;
    EXPECT_THROW(one.CheckStopped(), engine::Stopped);
    EXPECT_NO_THROW(other.CheckStopped());
}

TEST(Job, LetsWhatACallbackThrowsOutAndStaysUsable) {
    bool isAngry = true;
    Job job({.onProgress = [&](Progress const&) {
        if (isAngry) throw std::runtime_error("enough");
    }});
    EXPECT_THROW(job.Start("baking", 1), std::runtime_error);
    isAngry = false;
    EXPECT_NO_THROW(job.Start("baking", 1));
}

}  // namespace
}  // namespace limn
