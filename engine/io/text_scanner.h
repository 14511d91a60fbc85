// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

/// Walks the lines of a text file and the words of a line; numbers are read independent of the
/// locale. It never copies the text. Errors carry "FILE:LINE: ".
class TextScanner {
public:
    TextScanner(std::string_view text, std::string const& path) : _rest(text), _path(path) {}

    /// Moves to the next line that exists; false at the end. A CR before the end of line is
    /// dropped.
    bool NextLine() {
        if (_rest.empty()) return false;
        ++_lineNumber;
        size_t const end = _rest.find('\n');
        _endsWithNewline = end != std::string_view::npos;
        _line = _rest.substr(0, end);
        _rest.remove_prefix(_endsWithNewline ? end + 1 : _rest.size());
        if (!_line.empty() && _line.back() == '\r') _line.remove_suffix(1);
        return true;
    }

    /// The next word of the line; empty at its end.
    std::string_view Word() {
        SkipSpace();
        size_t end = 0;
        while (end < _line.size() && !IsSpace(_line[end])) ++end;
        std::string_view const word = _line.substr(0, end);
        _line.remove_prefix(end);
        return word;
    }

    bool AtEndOfLine() {
        SkipSpace();
        return _line.empty();
    }

    std::string_view RestOfLine() {
        SkipSpace();
        std::string_view rest = _line;
        while (!rest.empty() && IsSpace(rest.back())) rest.remove_suffix(1);
        _line = {};
        return rest;
    }

    /// A finite number. \throws Error BadMesh, naming `what`
    double Number(char const* what) {
        SkipSpace();
        char const* begin = _line.data();
        char const* const end = begin + _line.size();
        if (begin != end && *begin == '+') ++begin;
        double value = 0.0;
        auto const [stop, code] = std::from_chars(begin, end, value);
        bool const isWhole = stop == end || IsSpace(*stop);
        if (code == std::errc() && isWhole && std::abs(value) <= kLargest) {
            _line.remove_prefix(static_cast<size_t>(stop - _line.data()));
            return value;
        }
        RefuseNumber(what, code, value);
    }

    /// Numbers beyond this would pass the range of float somewhere between a file and its maps.
    static constexpr double kLargest = 1e30;

    [[noreturn]] void Refuse(std::string const& message) const {
        throw Error(ErrorCode::BadMesh, fmt::format("{}:{}: {}", _path, _lineNumber, message));
    }

    /// Cuts the line at a '#'.
    void DropComment() { _line = _line.substr(0, _line.find('#')); }

    /// The text after the current line.
    std::string_view GetRest() const { return _rest; }

    uint32_t GetLineNumber() const { return _lineNumber; }
    bool EndsWithNewline() const { return _endsWithNewline; }
    std::string const& GetPath() const { return _path; }

    static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

    /// A word as it can stand in a message: printable, at most 40 characters.
    static std::string Quote(std::string_view word) {
        std::string shown;
        for (char c : word.substr(0, 40)) shown += (c >= 32 && c < 127) ? c : '?';
        return fmt::format("'{}{}'", shown, word.size() > 40 ? "..." : "");
    }

private:
    void SkipSpace() {
        while (!_line.empty() && IsSpace(_line.front())) _line.remove_prefix(1);
    }

    [[noreturn]] void RefuseNumber(char const* what, std::errc code, double value) {
        std::string_view const word = Word();
        if (word.empty()) Refuse(fmt::format("{} is missing", what));
        if (code == std::errc::result_out_of_range ||
            (code == std::errc() && std::isfinite(value) && std::abs(value) > kLargest)) {
            Refuse(fmt::format("{} is {}; at most {:g} in magnitude is possible", what, Quote(word),
                               kLargest));
        }
        Refuse(fmt::format("{} is {}; a finite number is needed", what, Quote(word)));
    }

    std::string_view _rest, _line;
    std::string const& _path;
    uint32_t _lineNumber = 0;
    bool _endsWithNewline = true;
};

}  // namespace limn::engine
