// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace limn::far_ext {

/// Allocates for arrays of many megabytes that are filled at once: from the system's large pages,
/// where it has some to give (the first touch of small ones costs more than what is computed into
/// them), and without setting numbers to 0.
template <class T>
class LargeArrayAllocator {
public:
    using value_type = T;

    LargeArrayAllocator() = default;
    template <class U>
    LargeArrayAllocator(LargeArrayAllocator<U> const&) noexcept {}

    T* allocate(std::size_t count) {
        if (count > kMostBytes / sizeof(T)) throw std::bad_alloc();
        std::size_t const size = (count * sizeof(T) + kPage - 1) / kPage * kPage;
        if (!IsLarge(count))
            return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(kLine)));
        void* const block = std::aligned_alloc(kPage, size);
        if (!block) throw std::bad_alloc();
#ifdef __linux__
        ::madvise(block, size, MADV_HUGEPAGE);  // where it is refused, small pages do
#endif
        return static_cast<T*>(block);
    }

    void deallocate(T* block, std::size_t count) noexcept {
        if (IsLarge(count))
            std::free(block);
        else
            ::operator delete(block, std::align_val_t(kLine));
    }

    /// A number is left as the memory was.
    template <class U, class... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        if constexpr (sizeof...(arguments) == 0)
            ::new (static_cast<void*>(at)) U;
        else
            ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }

    bool operator==(LargeArrayAllocator const&) const { return true; }

private:
    static constexpr std::size_t kLine = 64, kPage = std::size_t{2} << 20;
    static constexpr std::size_t kMostBytes = PTRDIFF_MAX - kPage;
    static bool IsLarge(std::size_t count) { return count * sizeof(T) >= kPage; }
};

/// A std::vector of the above. What resize adds, has no value yet.
template <class T>
using LargeArray = std::vector<T, LargeArrayAllocator<T>>;

}  // namespace limn::far_ext
