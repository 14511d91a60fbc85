// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "eval/fit/limit_operator.h"

namespace limn::eval {

/// The components on which A is singular: closed, all valences 3, all faces with an even number of
/// sides, and bipartite, such as a cube or a hexagonal prism. There A maps the vector that is +1
/// and -1 in turn to zero, and data lie in the range of A where they are orthogonal to it.
///
/// Source  [Limit 5]; [LaiCheng11] Appendix B, which gives such meshes up.
class SingularComponents {
public:
    explicit SingularComponents(LimitOperator const& A);

    struct Component {
        std::vector<Index> vertices;  ///< in the order they were found; the first has sign +1
        std::vector<signed char> signs;
    };

    std::vector<Component> const& Get() const { return _components; }

    /// Length of the alternating part of a component's rows: what no P can reach.
    static double FindDefect(Component const& component, double const* values, int length);

    /// Takes the alternating part out of all components.
    void Project(double* values, int length) const;

private:
    std::vector<Component> _components;
};

}  // namespace limn::eval
