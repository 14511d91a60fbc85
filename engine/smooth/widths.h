// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "engine/smooth/edge_widths.h"
#include "engine/smooth/painted_widths.h"
#include "engine/smooth/smooth_levels.h"
#include "engine/smooth/vertex_widths.h"

namespace limn::engine {

/// Everywhere the same.
struct ConstantWidth {
    double sigma = 0.0;
};

/// The width (sigma, in mesh units) of a geometric filter, by place. Those near edges and painted
/// ones are evaluated anew on every level, and not filtered.
using FilterWidths = std::variant<ConstantWidth, VertexWidths, EdgeWidths, PaintedWidths>;

/// \throws Error  BadOption: a width that is no number from 0 up, widths for another number of
///                vertices
void CheckWidths(FilterWidths const& widths, Model const& model);

/// Widths as a cascade asks for them, with a factor on all of them.
class ScaledWidths {
public:
    /// \param widths  kept by reference
    ScaledWidths(FilterWidths const& widths, double factor) : _widths(widths), _factor(factor) {}

    double GetLargest() const;

    /// Along edges that are no longer, widths are known from those at the ends.
    double GetResolvedLength() const;

    /// The width where it is the same everywhere.
    std::optional<double> GetConstant() const;

    /// Per vertex of the control mesh; 0 where widths are evaluated anew on every level, empty
    /// where they are the same everywhere.
    std::vector<double> GetStart(Model const& model) const;

    /// Per vertex of the mesh that `levels` made last; empty where the kind is not evaluated anew.
    ///
    /// \param positions  of the start surface on that level
    std::vector<double> SampleLevel(SmoothLevels& levels,
                                    std::vector<double> const& positions) const;

private:
    FilterWidths const& _widths;
    double _factor;
};

}  // namespace limn::engine
