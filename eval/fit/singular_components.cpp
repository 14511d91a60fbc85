// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/singular_components.h"

#include <cmath>

namespace limn::eval {

namespace {

/// The alternating part of one channel: sum of signs times values, per vertex.
double FindAlternation(SingularComponents::Component const& component, double const* values,
                       int length, int channel) {
    double sum = 0.0;
    for (size_t i = 0; i < component.vertices.size(); ++i) {
        sum += component.signs[i] *
               values[static_cast<size_t>(component.vertices[i]) * length + channel];
    }
    return sum / static_cast<double>(component.vertices.size());
}

}  // namespace

SingularComponents::SingularComponents(LimitOperator const& A) {
    std::vector<signed char> signs;  // of all vertices: 0 where not seen; made when first needed
    for (Index seed = 0; seed < A.GetNumVertices(); ++seed) {
        if (!A.GetClass(seed).isEvenCubic) continue;
        if (signs.empty()) signs.assign(A.GetNumVertices(), 0);
        if (signs[seed] != 0) continue;
        // Through the whole patch of such vertices, also where it turns out not to be a component
        // of its own.
        bool isSingular = true;
        Component component;
        component.vertices.push_back(seed);
        signs[seed] = 1;
        for (size_t i = 0; i < component.vertices.size(); ++i) {
            Index const row = component.vertices[i];
            component.signs.push_back(signs[row]);
            for (Index neighbour : A.GetNeighbours(row).first(3)) {
                if (!A.GetClass(neighbour).isEvenCubic || signs[neighbour] == signs[row]) {
                    isSingular = false;
                } else if (signs[neighbour] == 0) {
                    signs[neighbour] = static_cast<signed char>(-signs[row]);
                    component.vertices.push_back(neighbour);
                }
            }
        }
        if (isSingular) _components.push_back(std::move(component));
    }
}

double SingularComponents::FindDefect(Component const& component, double const* values,
                                      int length) {
    double square = 0.0;
    for (int c = 0; c < length; ++c) {
        double const part = FindAlternation(component, values, length, c);
        square += part * part;
    }
    return std::sqrt(square);
}

void SingularComponents::Project(double* values, int length) const {
    for (Component const& component : _components) {
        for (int c = 0; c < length; ++c) {
            double const part = FindAlternation(component, values, length, c);
            for (size_t i = 0; i < component.vertices.size(); ++i) {
                values[static_cast<size_t>(component.vertices[i]) * length + c] -=
                    component.signs[i] * part;
            }
        }
    }
}

}  // namespace limn::eval
