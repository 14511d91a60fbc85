// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace limn::engine {

/// A smooth run through equally spaced colours: the cubic B-spline that interpolates them, its ends
/// being corners. Its control points solve the curve's limit rule (c[i-1] + 4 c[i] + c[i+1]) / 6 =
/// colour[i].
///
/// Source   [LaiCheng11] Sec. 5; [Limit 8]
class ColourRamp {
public:
    using Colour = std::array<double, 3>;

    /// \throws Error  BadOption: fewer than two colours
    explicit ColourRamp(std::vector<Colour> const& colours);

    /// "#rrggbb,#rrggbb,...": shares of 255. \throws Error BadOption, naming the colour
    static ColourRamp Parse(std::string const& text);

    /// As Parse takes it, in canonical form.
    std::string GetText() const;

    /// The colour at t in [0, 1]; t beyond is clamped. Components may pass [0, 1] a little between
    /// colours.
    Colour Evaluate(double t) const;

private:
    std::vector<Colour> _colours;
    std::vector<Colour> _control;  // with one more point beyond each end
};

}  // namespace limn::engine
