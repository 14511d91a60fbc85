// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "engine/io/unheld_number.h"
#include "engine/scene/scene_checks.h"
#include "far_ext/error.h"

namespace limn::engine {

/// Walks the lines of a text file and the words of a line; numbers are read independent of the
/// locale. A UTF-8 mark at the beginning is no part of the text, and lines end with LF, CR LF, LF
/// CR or CR. It copies nothing but lines that are joined. Errors carry "FILE:LINE: ".
class TextScanner {
public:
    /// What a backslash at the end of a line, or before blanks there, means. One behind a '#'
    /// belongs to a comment and means nothing.
    enum class Backslash { IsText, JoinsLines };

    /// \throws Error  BadMesh: UTF-16
    TextScanner(std::string_view text, std::string const& path,
                Backslash backslash = Backslash::IsText)
        : _text(WithoutMark(text)), _path(path), _joinsLines(backslash == Backslash::JoinsLines) {
        if (_text.starts_with("\xff\xfe") || _text.starts_with("\xfe\xff")) {
            _lineNumber = 1;
            Refuse("this is not text in ASCII or UTF-8 but in UTF-16; UTF-8 is needed");
        }
    }

    /// Moves to the next line that exists, joined with those that continue it; false at the end.
    bool NextLine() {
        if (_next == _text.size()) return false;
        _line = TakeLine();
        _lineNumber = _numLines;
        if (_joinsLines) JoinLines();
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

    /// Moves behind a word's beginning, if it stands here.
    bool Skip(std::string_view beginning) {
        SkipSpace();
        if (!_line.starts_with(beginning)) return false;
        _line.remove_prefix(beginning.size());
        return true;
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

    /// A number of at most kLargest in magnitude. \throws Error BadMesh, naming `what`
    double Number(char const* what) {
        SkipSpace();
        ParsedNumber const parsed = ParseNumber(_line);
        if (!parsed.IsUsable()) RefuseNumber(what, parsed);
        _line.remove_prefix(parsed.length);
        return parsed.value;
    }

    /// The same; nothing, and no move, where there is none.
    std::optional<double> TryNumber() {
        SkipSpace();
        ParsedNumber const parsed = ParseNumber(_line);
        if (!parsed.IsUsable()) return std::nullopt;
        _line.remove_prefix(parsed.length);
        return parsed.value;
    }

    static constexpr double kLargest = kLargestNumber;

    [[noreturn]] void Refuse(std::string const& message) const { RefuseAt(_lineNumber, message); }
    [[noreturn]] void RefuseAt(uint32_t line, std::string const& message) const {
        throw Error(ErrorCode::BadMesh, fmt::format("{}:{}: {}", _path, line, message));
    }

    /// Cuts the line at a '#'.
    void DropComment() { _line = _line.substr(0, _line.find('#')); }

    /// The text after the current line.
    std::string_view GetRest() const { return _text.substr(_next); }

    /// What follows the current line where that is no text: the line ends as the first one did, for
    /// the next byte may look like a part of its end.
    std::string_view GetBytesBehind() const {
        std::string_view const rest = _text.substr(_endOfLine);
        bool const isAlike = rest.starts_with(_firstLineEnd);
        return rest.substr(isAlike ? _firstLineEnd.size() : std::min<size_t>(1, rest.size()));
    }

    /// Of the current line, or of the first of those that are joined in it; from 1.
    uint32_t GetLineNumber() const { return _lineNumber; }
    bool EndsWithNewline() const { return _endOfLine != _text.size(); }
    std::string const& GetPath() const { return _path; }

    static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

    /// A word as it can stand in a message: printable, at most 40 characters.
    static std::string Quote(std::string_view word) {
        std::string shown;
        for (char c : word.substr(0, 40)) shown += (c >= 32 && c < 127) ? c : '?';
        return fmt::format("'{}{}'", shown, word.size() > 40 ? "..." : "");
    }

    /// A number at the beginning of a text, as far as the next space.
    struct ParsedNumber {
        double value = 0.0;
        size_t length = 0;
        std::errc code{};

        bool IsUnheld() const { return code == std::errc::result_out_of_range; }
        bool IsNumber() const { return code == std::errc() && std::isfinite(value); }
        bool IsUsable() const { return code == std::errc() && std::abs(value) <= kLargest; }
    };

    static ParsedNumber ParseNumber(std::string_view text) {
        bool const hasPlus = text.size() > 1 && text[0] == '+' && text[1] != '-';
        char const* const begin = text.data() + hasPlus;
        char const* const end = text.data() + text.size();
        ParsedNumber parsed;
        auto const [stop, code] = std::from_chars(begin, end, parsed.value);
        parsed.length = static_cast<size_t>(stop - text.data());
        parsed.code = stop == end || IsSpace(*stop) ? code : std::errc::invalid_argument;
        return parsed;
    }

    /// The text behind a UTF-8 mark.
    static std::string_view WithoutMark(std::string_view text) {
        return text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
    }

private:
    /// The next line of the file as it stands there. Both kinds of ends are looked for once: a file
    /// has one of them, and each line must not look for the other to the file's end.
    std::string_view TakeLine() {
        if (_nextFeed < _next || _numLines == 0) _nextFeed = Find('\n');
        if (_nextReturn < _next || _numLines == 0) _nextReturn = Find('\r');
        size_t const begin = _next;
        _endOfLine = std::min(_nextFeed, _nextReturn);
        bool const isPair = _nextFeed != _nextReturn &&
                            std::max(_nextFeed, _nextReturn) == _endOfLine + 1 &&
                            _endOfLine + 1 < _text.size();
        _next = std::min(_endOfLine + (isPair ? 2 : 1), _text.size());
        if (_numLines++ == 0) _firstLineEnd = _text.substr(_endOfLine, _next - _endOfLine);
        return _text.substr(begin, _endOfLine - begin);
    }

    size_t Find(char c) const { return std::min(_text.find(c, _next), _text.size()); }

    /// The place of the backslash that continues a line; npos without one.
    static size_t FindContinuation(std::string_view line) {
        size_t last = line.size();
        while (last > 0 && IsSpace(line[last - 1])) --last;
        bool const isContinued = last > 0 && line[last - 1] == '\\' && line.find('#') == line.npos;
        return isContinued ? last - 1 : line.npos;
    }

    /// Makes the current line one with those that continue it; a blank stands for each backslash.
    void JoinLines() {
        size_t end = FindContinuation(_line);
        if (end == _line.npos) return;
        _joined.clear();
        for (; end != _line.npos; end = FindContinuation(_line)) {
            _joined.append(_line, 0, end).append(" ");
            _line = _next == _text.size() ? std::string_view() : TakeLine();
        }
        _line = _joined.append(_line);
    }

    void SkipSpace() {
        while (!_line.empty() && IsSpace(_line.front())) _line.remove_prefix(1);
    }

    [[noreturn]] void RefuseNumber(char const* what, ParsedNumber const& parsed) {
        std::string_view const word = Word();
        if (word.empty()) Refuse(fmt::format("{} is missing", what));
        if (parsed.IsUnheld() && IsTooSmall(word))
            Refuse(fmt::format("{} is {}, {}", what, Quote(word), DescribeUnheld(word)));
        if (parsed.IsUnheld() || parsed.IsNumber()) {
            Refuse(fmt::format("{} is {}; at most {:g} in magnitude is possible", what, Quote(word),
                               kLargest));
        }
        Refuse(fmt::format("{} is {}; a finite number is needed", what, Quote(word)));
    }

    std::string_view _text, _line, _firstLineEnd;
    std::string const& _path;
    bool _joinsLines;
    size_t _next = 0, _endOfLine = 0;         // where the next line begins, and where this ends
    size_t _nextFeed = 0, _nextReturn = 0;    // from _next on; the text's size without one
    uint32_t _lineNumber = 0, _numLines = 0;  // of the statement's first line; of those taken
    std::string _joined;
};

}  // namespace limn::engine
