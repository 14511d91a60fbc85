// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

namespace {

thread_local bool isMemoryShort = false;

}  // namespace

void* operator new(size_t size) {
    void* const memory = isMemoryShort ? nullptr : std::malloc(size);
    if (!memory) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}

namespace limn {
namespace {

// What fails for want of memory lets go of its strips: that must not fail, too.
TEST(StripPool, TakesStripsBackWithoutMemory) {
    engine::StripPool pool;
    auto const grid = engine::TileGrid::OfTile(1001, 16, 20 * engine::Strip::kRows);
    std::vector<std::shared_ptr<engine::Strip>> held;
    std::vector<engine::Strip*> strips;
    for (int i = 0; i < 20; ++i) {
        held.push_back(pool.Acquire(i, 1, grid, false));
        strips.push_back(held.back().get());
    }
    isMemoryShort = true;
    for (auto& strip : held) strip.reset();
    isMemoryShort = false;
    EXPECT_TRUE(std::ranges::count(strips, pool.Acquire(0, 1, grid, false).get()) == 1);
}

}  // namespace
}  // namespace limn
