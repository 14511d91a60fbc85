// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

/// What the bench programs share. Numbers of one machine are only worth as ratios of one run, so
/// all variants run in turns, round after round, with the memory's copy bandwidth of the same
/// rounds beside them. A program whose result is wrong ends with status 1 and reports no times.
namespace limn::bench {

/// Ends the program if a result is wrong.
inline void Check(bool isRight, std::string const& what) {
    if (isRight) return;
    fmt::print(stderr, "WRONG: {}\n", what);
    std::exit(1);
}

/// Number of rounds: 9, or "--rounds N" (1 for a quick look at the results alone).
inline int GetNumRounds(int argc, char** argv) {
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::string_view(argv[i]) == "--rounds") return std::max(1, std::atoi(argv[i + 1]));
    }
    return 9;
}

inline double GetLoadAverage() {
    double load = 0.0;
    std::ifstream("/proc/loadavg") >> load;
    return load;
}

/// Seconds of processor time so far, of all threads and of child processes that have ended.
inline double GetProcessorTime() {
    double seconds = 0.0;
    for (int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        ::getrusage(who, &usage);
        for (timeval const& time : {usage.ru_utime, usage.ru_stime}) {
            seconds += static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
        }
    }
    return seconds;
}

/// Variants of one job, timed in turns.
class Rounds {
public:
    struct Time {
        double median, best;  ///< seconds
        double processor;     ///< median seconds of processor time, all threads and child processes
    };

    explicit Rounds(int numRounds) : _numRounds(numRounds) {}

    /// \param items  what one run handles, for the rate; 0 for none
    /// \return       the variant's number
    size_t Add(std::string name, std::function<void()> run, double items = 0.0) {
        _variants.push_back({std::move(name), std::move(run), items, {}, {}});
        return _variants.size() - 1;
    }

    /// One round to warm up, then the timed ones; prints a line per variant.
    void Run(char const* unit = "items") {
        std::vector<char> from(kCopiedBytes, 1), to(kCopiedBytes, 2);
        _copy = Add("copy 128 MiB (the memory's limit)",
                    [&] { std::memcpy(to.data(), from.data(), kCopiedBytes); });
        double const loadBefore = GetLoadAverage();
        for (int round = -1; round < _numRounds; ++round) {
            for (Variant& variant : _variants) {
                auto const start = std::chrono::steady_clock::now();
                double const startProcessor = GetProcessorTime();
                variant.run();
                std::chrono::duration<double> const elapsed =
                    std::chrono::steady_clock::now() - start;
                if (round < 0) continue;
                variant.seconds.push_back(elapsed.count());
                variant.processorSeconds.push_back(GetProcessorTime() - startProcessor);
            }
        }
        for (size_t i = 0; i < _variants.size(); ++i) {
            Variant const& variant = _variants[i];
            Time const time = Get(i);
            fmt::print("  {:<52} median {:9.2f} ms   best {:9.2f} ms", variant.name,
                       time.median * 1e3, time.best * 1e3);
            if (variant.items > 0.0)
                fmt::print("   {:8.2f} M {}/s", variant.items / time.median * 1e-6, unit);
            if (i == _copy) fmt::print("   {:8.1f} GB/s", GetCopyBandwidth() * 1e-9);
            fmt::print("\n");
        }
        double const loadAfter = GetLoadAverage(),
                     numCores = static_cast<double>(std::thread::hardware_concurrency());
        fmt::print("  {} rounds; load average {:.2f} before, {:.2f} after\n", _numRounds,
                   loadBefore, loadAfter);
        if (std::max(loadBefore, loadAfter) > numCores + 0.5)
            fmt::print("  BUSY: others used the machine; do not quote these ratios\n");
        std::fflush(stdout);
    }

    Time Get(size_t variant) const {
        auto const sort = [](std::vector<double> values) {
            std::sort(values.begin(), values.end());
            return values;
        };
        auto const seconds = sort(_variants[variant].seconds),
                   processor = sort(_variants[variant].processorSeconds);
        return {seconds[seconds.size() / 2], seconds.front(), processor[processor.size() / 2]};
    }

    /// Bytes per second, read and written, of copying memory in the same rounds.
    double GetCopyBandwidth() const {
        return 2.0 * static_cast<double>(kCopiedBytes) / Get(_copy).median;
    }

    /// Prints how many times faster `ours` is than `theirs`, by medians, by best times, and by
    /// processor time, which other programs on the machine disturb least.
    void Compare(char const* what, size_t ours, size_t theirs,
                 std::optional<double> target = {}) const {
        Time const a = Get(ours), b = Get(theirs);
        double const ratio = b.median / a.median;
        fmt::print("  => {}: {:.2f}x (best times {:.2f}x, processor {:.2f}x)", what, ratio,
                   b.best / a.best, b.processor / a.processor);
        if (target)
            fmt::print(", target {}x: {}", *target, ratio >= *target ? "reached" : "MISSED");
        fmt::print("\n");
        std::fflush(stdout);
    }

private:
    static constexpr size_t kCopiedBytes = size_t{128} << 20;  // far beyond any cache

    struct Variant {
        std::string name;
        std::function<void()> run;
        double items;
        std::vector<double> seconds, processorSeconds;
    };

    int _numRounds;
    size_t _copy = 0;
    std::vector<Variant> _variants;
};

/// Runs `work` on a number of threads of the one pool.
template <class Work>
void OnThreads(int numThreads, Work const& work) {
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(numThreads));
    work();
}

struct Memory {
    double peak, growth;  ///< MiB: the process at its largest, and that less what it started with
};

/// Largest resident size while `work` runs in a child process. To be asked before anything else has
/// been done: a child inherits what its parent holds, and no threads.
template <class Work>
Memory MeasureMemory(Work const& work) {
    auto const readStatus = [](std::string_view key) {
        std::ifstream file("/proc/self/status");
        for (std::string line; std::getline(file, line);) {
            if (line.starts_with(key)) return std::atof(line.c_str() + key.size() + 1) / 1024.0;
        }
        return 0.0;
    };
    std::fflush(stdout);
    int ends[2];
    Check(::pipe(ends) == 0, "no pipe");
    pid_t const child = ::fork();
    Check(child >= 0, "no child process");
    if (child == 0) {
        double const before = readStatus("VmRSS");
        work();
        double const peak = readStatus("VmHWM");
        Memory const memory{peak, peak - before};
        bool const isSent = ::write(ends[1], &memory, sizeof memory) == sizeof memory;
        ::_exit(isSent ? 0 : 1);
    }
    ::close(ends[1]);
    Memory memory{};
    bool const isReceived = ::read(ends[0], &memory, sizeof memory) == sizeof memory;
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    Check(isReceived && status == 0, "the measured child process failed");
    return memory;
}

/// Exponent e of cost ~ size^e, by least squares of the logarithms.
inline double FitExponent(std::vector<double> const& sizes, std::vector<double> const& costs) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0, n = static_cast<double>(sizes.size());
    for (size_t i = 0; i < sizes.size(); ++i) {
        double const x = std::log(sizes[i]), y = std::log(costs[i]);
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace limn::bench
