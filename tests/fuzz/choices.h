// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>

namespace limn::fuzz {

/// Bytes as a row of choices. Every input means something: where the bytes end, each choice is the
/// first there is, so short inputs are simple ones, and a byte that is cut off changes little.
class Choices {
public:
    explicit Choices(std::span<uint8_t const> bytes) : _bytes(bytes) {}

    bool IsAtEnd() const { return _bytes.empty(); }

    uint8_t TakeByte() {
        if (_bytes.empty()) return 0;
        uint8_t const byte = _bytes.front();
        _bytes = _bytes.subspan(1);
        return byte;
    }

    bool TakeBool() { return TakeByte() % 2 != 0; }

    /// True once in `count` times, never at the end.
    bool TakeOneIn(int count) { return TakeByte() % count == count - 1; }

    /// From `low` to `high`, both included; the span is at most 65536.
    int TakeInt(int low, int high) {
        int const count = high - low + 1;
        int const value = count <= 256 ? TakeByte() : TakeByte() + 256 * TakeByte();
        return low + value % count;
    }

    /// From -1 to 1, in steps of 1/128, so that small numbers meet often.
    double TakeSigned() { return static_cast<int8_t>(TakeByte()) / 128.0; }

    /// From 0 to 1, both included.
    double TakeShare() { return TakeByte() / 255.0; }

    template <class Row>
    auto Pick(Row const& row) -> decltype(*std::begin(row)) {
        return *std::next(std::begin(row), TakeInt(0, static_cast<int>(std::size(row)) - 1));
    }
    template <class T>
    T Pick(std::initializer_list<T> row) {
        return *std::next(row.begin(), TakeInt(0, static_cast<int>(row.size()) - 1));
    }

private:
    std::span<uint8_t const> _bytes;
};

}  // namespace limn::fuzz
