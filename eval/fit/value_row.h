// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>

#include "far_ext/types.h"

namespace limn::eval {

/// The values of one vertex, as the limit operator gathers and blends them: Length doubles that lie
/// one after another.
template <int Length>
struct DoubleRow {
    using Scalar = double;
    static constexpr size_t kStride = Length;

    std::array<double, Length> values{};

    static DoubleRow Load(double const* rows, Index vertex) {
        DoubleRow row;
        std::memcpy(row.values.data(), rows + vertex * kStride, sizeof row.values);
        return row;
    }
    void Store(double* rows, Index vertex) const {
        std::memcpy(rows + vertex * kStride, values.data(), sizeof values);
    }

    friend DoubleRow operator+(DoubleRow a, DoubleRow const& b) {
        for (size_t i = 0; i < Length; ++i) a.values[i] += b.values[i];
        return a;
    }
    friend DoubleRow operator-(DoubleRow a, DoubleRow const& b) {
        for (size_t i = 0; i < Length; ++i) a.values[i] -= b.values[i];
        return a;
    }
    friend DoubleRow operator*(double weight, DoubleRow a) {
        for (double& value : a.values) value *= weight;
        return a;
    }
    double SquaredLength() const {
        double sum = 0.0;
        for (double value : values) sum += value * value;
        return sum;
    }
};

/// The same in float, for the inner steps of iterations: one number, or four in a vector register
/// (unused ones are 0). Both give the same bits on every CPU.
template <int Lanes>
struct FloatRow;

template <>
struct FloatRow<1> {
    using Scalar = float;
    static constexpr size_t kStride = 1;

    float value = 0.0f;

    static FloatRow Load(float const* rows, Index vertex) { return {rows[vertex]}; }
    void Store(float* rows, Index vertex) const { rows[vertex] = value; }

    friend FloatRow operator+(FloatRow a, FloatRow b) { return {a.value + b.value}; }
    friend FloatRow operator-(FloatRow a, FloatRow b) { return {a.value - b.value}; }
    friend FloatRow operator*(float weight, FloatRow a) { return {weight * a.value}; }
    float SquaredLength() const { return value * value; }
};

template <>
struct FloatRow<4> {
    using Scalar = float;
    static constexpr size_t kStride = 4;
    typedef float Lanes4 __attribute__((vector_size(16)));

    Lanes4 values{};

    static FloatRow Load(float const* rows, Index vertex) {
        FloatRow row;
        std::memcpy(&row.values, rows + vertex * kStride, sizeof row.values);
        return row;
    }
    void Store(float* rows, Index vertex) const {
        std::memcpy(rows + vertex * kStride, &values, sizeof values);
    }

    friend FloatRow operator+(FloatRow a, FloatRow b) { return {a.values + b.values}; }
    friend FloatRow operator-(FloatRow a, FloatRow b) { return {a.values - b.values}; }
    friend FloatRow operator*(float weight, FloatRow a) { return {weight * a.values}; }
    float SquaredLength() const {
        Lanes4 const squares = values * values;
        return (squares[0] + squares[1]) + (squares[2] + squares[3]);
    }
};

/// Calls f.operator()<Length>() with a row's length, 1 to 4, known when compiling.
template <class F>
void WithLength(int length, F const& f) {
    switch (length) {
        case 1:
            return f.template operator()<1>();
        case 2:
            return f.template operator()<2>();
        case 3:
            return f.template operator()<3>();
        default:
            return f.template operator()<4>();
    }
}

}  // namespace limn::eval
