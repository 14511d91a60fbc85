// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

#include <malloc.h>

/// Counts what a program has on its heap, by standing in for the allocator's entry points. To be
/// included in one source file of a program only.
namespace limn::bench {

struct HeapCount {
    std::atomic<long> now{0}, peak{0};

    void Add(void* block) {
        if (!block) return;
        long const size = now.fetch_add(static_cast<long>(malloc_usable_size(block))) +
                          static_cast<long>(malloc_usable_size(block));
        long seen = peak.load();
        while (seen < size && !peak.compare_exchange_weak(seen, size)) {
        }
    }
    void Remove(void* block) {
        if (block) now -= static_cast<long>(malloc_usable_size(block));
    }
};

inline constinit HeapCount heapCount;

/// Largest number of MiB that `work` had on the heap at a time. A first run, which fills what lives
/// on (tables of libraries, buffers of streams), is not counted.
template <class Work>
double MeasureHeapPeak(Work const& work) {
    work();
    long const before = heapCount.now;
    heapCount.peak = before;
    work();
    return static_cast<double>(heapCount.peak - before) / (1024.0 * 1024.0);
}

}  // namespace limn::bench

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the C library's names
extern "C" {

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);

void* malloc(size_t size) {
    void* const block = __libc_malloc(size);
    limn::bench::heapCount.Add(block);
    return block;
}

void* calloc(size_t count, size_t size) {
    void* const block = __libc_calloc(count, size);
    limn::bench::heapCount.Add(block);
    return block;
}

void* realloc(void* old, size_t size) {
    limn::bench::heapCount.Remove(old);
    void* const block = __libc_realloc(old, size);
    limn::bench::heapCount.Add(block ? block : old);
    return block;
}

void* memalign(size_t alignment, size_t size) {
    void* const block = __libc_memalign(alignment, size);
    limn::bench::heapCount.Add(block);
    return block;
}

void* aligned_alloc(size_t alignment, size_t size) {
    return memalign(alignment, size);
}

int posix_memalign(void** block, size_t alignment, size_t size) {
    *block = memalign(alignment, size);
    return *block ? 0 : 12;  // ENOMEM
}

void free(void* block) {
    limn::bench::heapCount.Remove(block);
    __libc_free(block);
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
