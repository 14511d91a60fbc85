// SPDX-License-Identifier: Apache-2.0
#include "engine/images/colour_ramp.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

ColourRamp::ColourRamp(std::vector<Colour> const& colours) : _colours(colours) {
    size_t const count = colours.size();
    if (count < 2)
        throw Error(ErrorCode::BadOption, "`noiseRamp`: at least two colours are needed");
    std::vector<Colour> control =
        colours;  // ends are corners: control point and colour are the same
    for (size_t c = 0; c < 3; ++c) {
        // The tridiagonal system of the inner points by elimination.
        std::vector<double> ratio(count, 0.0), right(count);
        right[0] = colours[0][c];
        for (size_t i = 1; i + 1 < count; ++i) {
            double const pivot = 4.0 - ratio[i - 1];
            ratio[i] = 1.0 / pivot;
            right[i] = (6.0 * colours[i][c] - right[i - 1]) / pivot;
        }
        for (size_t i = count - 2; i > 0; --i)
            control[i][c] = right[i] - ratio[i] * control[i + 1][c];
    }
    // A corner's curve has no curvature at its end: the point beyond mirrors the one before.
    auto const mirror = [](Colour const& end, Colour const& inner) {
        Colour beyond;
        for (size_t c = 0; c < 3; ++c) beyond[c] = 2.0 * end[c] - inner[c];
        return beyond;
    };
    _control.push_back(mirror(control[0], control[1]));
    _control.insert(_control.end(), control.begin(), control.end());
    _control.push_back(mirror(control[count - 1], control[count - 2]));
}

ColourRamp ColourRamp::Parse(std::string const& text) {
    std::vector<Colour> colours;
    for (size_t begin = 0; begin <= text.size();) {
        size_t const end = std::min(text.find(',', begin), text.size());
        std::string const word = text.substr(begin, end - begin);
        unsigned value = 0;
        char const* const last = word.data() + word.size();
        bool const hasForm = word.size() == 7 && word[0] == '#' &&
                             std::from_chars(word.data() + 1, last, value, 16) ==
                                 std::from_chars_result{last, std::errc()};
        if (!hasForm) {
            throw Error(
                ErrorCode::BadOption,
                fmt::format("`noiseRamp`: '{}' is not a colour; write #rrggbb, e.g. #ff8000",
                            word));
        }
        colours.push_back(
            {(value >> 16 & 255) / 255.0, (value >> 8 & 255) / 255.0, (value & 255) / 255.0});
        begin = end + 1;
    }
    return ColourRamp(colours);
}

std::string ColourRamp::GetText() const {
    std::string text;
    for (Colour const& colour : _colours) {
        auto const byte = [&](size_t c) {
            return static_cast<int>(std::lround(std::clamp(colour[c], 0.0, 1.0) * 255.0));
        };
        text += fmt::format("{}#{:02x}{:02x}{:02x}", text.empty() ? "" : ",", byte(0), byte(1),
                            byte(2));
    }
    return text;
}

ColourRamp::Colour ColourRamp::Evaluate(double t) const {
    size_t const numSpans = _control.size() - 3;
    double const at = std::clamp(t, 0.0, 1.0) * static_cast<double>(numSpans);
    size_t const span = std::min(static_cast<size_t>(at), numSpans - 1);
    double const x = at - static_cast<double>(span), y = 1.0 - x;
    double const weights[4] = {y * y * y / 6.0, (3.0 * x * x * x - 6.0 * x * x + 4.0) / 6.0,
                               (3.0 * y * y * y - 6.0 * y * y + 4.0) / 6.0, x * x * x / 6.0};
    Colour colour{};
    for (size_t k = 0; k < 4; ++k) {
        for (size_t c = 0; c < 3; ++c) colour[c] += weights[k] * _control[span + k][c];
    }
    return colour;
}

}  // namespace limn::engine
