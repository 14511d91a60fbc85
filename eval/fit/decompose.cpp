// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/decompose.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "far_ext/error.h"

namespace limn::eval {

void ApplyHighPass(LimitApplication const& A, int length, int power, std::vector<double>& x,
                   std::function<void(int, std::span<double const>)> const& visit) {
    std::vector<double> limit(x.size());
    if (visit) visit(0, x);
    for (int i = 1; i <= power; ++i) {
        A.Apply(x, length, limit);
        for (size_t k = 0; k < x.size(); ++k) x[k] -= limit[k];
        if (visit) visit(i, x);
    }
}

void WeighBands(LimitApplication const& A, int length, BandGains const& gains,
                std::vector<double>& x,
                std::function<void(int, std::span<double const>)> const& visit) {
    std::vector<double> rest = x, band(x.size());
    std::fill(x.begin(), x.end(), 0.0);
    auto const add = [&](double gain, std::vector<double> const& part) {
        for (size_t k = 0; k < x.size(); ++k) x[k] += gain * part[k];
    };
    for (int i = 0; i < gains.GetEnd(); ++i) {
        A.Apply(rest, length, band);
        if (visit) visit(i, band);
        if (i >= gains.first) add(gains.gains[i - gains.first], band);
        for (size_t k = 0; k < rest.size(); ++k) rest[k] -= band[k];
    }
    if (!gains.remainder) return;
    if (visit) visit(gains.GetEnd(), rest);
    add(*gains.remainder, rest);
}

void Denoise(LimitApplication const& A, int length, int detail, int steps, std::vector<double>& x) {
    std::vector<double> high;
    for (int step = 0; step < steps; ++step) {
        high = x;
        ApplyHighPass(A, length, detail + 1, high);
        for (size_t k = 0; k < x.size(); ++k) x[k] -= high[k];
    }
}

void Sharpen(LimitApplication const& A, int length, int first, int last, int steps,
             std::vector<double>& x) {
    std::vector<double> high;
    for (int step = 0; step < steps; ++step) {
        high = x;
        ApplyHighPass(A, length, last, high, [&](int i, std::span<double const> part) {
            for (size_t k = 0; i >= first && k < x.size(); ++k) x[k] += part[k];
        });
    }
}

void MorphStep(LimitApplication const& A, int length, int detail, double rate,
               std::span<double const> M, std::vector<double>& Q) {
    for (size_t k = 0; k < Q.size(); ++k) Q[k] -= M[k];
    Denoise(A, length, detail, 1, Q);
    for (size_t k = 0; k < Q.size(); ++k) Q[k] = M[k] + rate * Q[k];
}

void RequireFinite(std::span<double const> values, int length) {
    auto const bad =
        std::find_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); });
    if (bad == values.end()) return;
    throw Error(ErrorCode::BadMesh,
                "vertex " + std::to_string((bad - values.begin()) / length) +
                    " has a value that is not a finite number; give it one or remove the vertex");
}

}  // namespace limn::eval
