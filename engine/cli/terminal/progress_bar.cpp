// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/terminal/progress_bar.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace limn::cli {

namespace {

constexpr int kUsualColumns = 80, kLongestBar = 30, kShortestBar = 8;

/// A character as it is shown, and the columns that it may take.
struct Glyph {
    std::string_view shown;
    int columns = 1;
};

/// The number of bytes of a text's first character; 0 where it is no UTF-8, or moves the cursor.
size_t FindGlyphLength(std::string_view text) {
    auto const byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7f ? 1 : 0;
    size_t const length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
    if (byte(0) < 0xc2 || length > text.size()) return 0;
    for (size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
    }
    bool const isControl = byte(0) == 0xc2 && byte(1) < 0xa0;
    return isControl ? 0 : length;
}

std::vector<Glyph> SplitIntoGlyphs(std::string_view text) {
    std::vector<Glyph> glyphs;
    while (!text.empty()) {
        size_t const length = FindGlyphLength(text);
        // From three bytes on there are ideographs, two columns wide.
        glyphs.push_back({length > 0 ? text.substr(0, length) : "?", length > 2 ? 2 : 1});
        text.remove_prefix(std::max<size_t>(length, 1));
    }
    return glyphs;
}

int CountColumns(std::vector<Glyph> const& glyphs) {
    int columns = 0;
    for (Glyph const& glyph : glyphs) columns += glyph.columns;
    return columns;
}

/// As many glyphs as fit, with dots for the rest.
std::string Join(std::vector<Glyph> const& glyphs, int columns) {
    std::string_view const dots = CountColumns(glyphs) > columns ? "..." : "";
    int room = columns - static_cast<int>(dots.size());
    std::string text;
    for (Glyph const& glyph : glyphs) {
        room -= glyph.columns;
        if (room < 0) break;
        text += glyph.shown;
    }
    return text.append(dots);
}

int ReadColumnsVariable() {
    std::string_view const text = std::getenv("COLUMNS") ? std::getenv("COLUMNS") : "";
    int columns = 0;
    std::from_chars(text.data(), text.data() + text.size(), columns);
    return columns;
}

}  // namespace

std::optional<int> FindColumns() {
    std::string_view const kind = std::getenv("TERM") ? std::getenv("TERM") : "";
    if (!::isatty(STDERR_FILENO) || kind == "dumb") return std::nullopt;
    winsize size{};
    int const said = ReadColumnsVariable();
    bool const isKnown = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    int const has = isKnown ? size.ws_col : said > 0 ? said : kUsualColumns;
    return said > 0 ? std::min(said, has) : has;
}

std::string FormatSeconds(double seconds) {
    if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
    if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
    if (seconds < 7200.0) return fmt::format("{:.0f} min", seconds / 60.0);
    return fmt::format("{:.1f} h", seconds / 3600.0);
}

std::string FormatBar(std::string_view phase, double share, std::string_view time, int columns) {
    auto const name = SplitIntoGlyphs(phase);
    std::string const end = fmt::format("{:3.0f} %  {}", 100.0 * share, time);
    // The last column stays free: some terminals wrap once it is filled.
    int const room = columns - 1 - static_cast<int>(end.size()) - 1;
    int const length = std::min(kLongestBar, room - CountColumns(name) - 3);
    if (length >= kShortestBar) {
        int const filled = static_cast<int>(share * length);
        return fmt::format("{} [{:=<{}}{: <{}}] {}", Join(name, room), "", filled, "",
                           length - filled, end);
    }
    if (room < 4) return end.substr(0, static_cast<size_t>(std::max(columns - 1, 0)));
    return fmt::format("{} {}", Join(name, room), end);
}

}  // namespace limn::cli
