// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <opensubdiv/osd/cpuEvaluator.h>

#include "far_ext/limit/limit_matrix.h"

namespace limn::bench {

/// Plain progressive interpolation, P += M - A P, with A as a stencil table in OpenSubdiv's
/// evaluator: what its users would write. Rows of 3 floats.
class OsdProgressive {
public:
    OsdProgressive(far_ext::LimitMatrix const& A, std::vector<double> const& M)
        : _limitMatrix(A),
          _weights(A.MakeFloatWeights()),
          _data(M.begin(), M.end()),
          _control(_data.size()),
          _limit(_data.size()) {}

    /// Iterates until max |M - A P| <= tolerance. Returns the number of applications of A.
    int Solve(double tolerance) {
        namespace Osd = OpenSubdiv::Osd;
        Osd::BufferDescriptor const rows(0, 3, 3);
        _control = _data;
        for (int count = 1;; ++count) {
            Osd::CpuEvaluator::EvalStencils(
                _control.data(), rows, _limit.data(), rows, _limitMatrix.GetSizes().data(),
                _limitMatrix.GetOffsets().data(), _limitMatrix.GetControlIndices().data(),
                _weights.data(), 0, _limitMatrix.GetNumStencils());
            float largest = 0.0f;
            for (size_t i = 0; i < _data.size(); i += 3) {
                float square = 0.0f;
                for (size_t c = 0; c < 3; ++c) {
                    float const residual = _data[i + c] - _limit[i + c];
                    square += residual * residual;
                    _control[i + c] += residual;
                }
                largest = std::max(largest, square);
            }
            if (std::sqrt(static_cast<double>(largest)) <= tolerance || count == 1000) return count;
        }
    }

    std::vector<float> const& GetControl() const { return _control; }

private:
    far_ext::LimitMatrix const& _limitMatrix;
    std::vector<float> _weights, _data, _control, _limit;
};

}  // namespace limn::bench
