// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/io/text_scanner.h"

namespace limn::engine {

/// Lines that are read over, by the word that names them: for one warning, however many there are.
class SkippedLines {
public:
    void Add(std::string_view word, uint32_t line) {
        if (_count++ == 0) _firstLine = line;
        bool const isNew = std::find(_words.begin(), _words.end(), word) == _words.end();
        if (!isNew) return;
        if (_words.size() < kMaxWords)
            _words.emplace_back(word);
        else
            _hasMoreWords = true;
    }

    size_t GetCount() const { return _count; }
    uint32_t GetFirstLine() const { return _firstLine; }

    /// "1 line", "7 lines"
    std::string DescribeCount() const {
        return fmt::format("{} line{}", _count, _count == 1 ? "" : "s");
    }

    /// "1 line ('vp')" or "7 lines ('curv', 'surf', ...)"
    std::string Describe() const {
        std::string words;
        for (std::string const& word : _words)
            words += (words.empty() ? "" : ", ") + TextScanner::Quote(word);
        return fmt::format("{} ({}{})", DescribeCount(), words, _hasMoreWords ? ", ..." : "");
    }

private:
    static constexpr size_t kMaxWords = 6;

    std::vector<std::string> _words;  // the first few distinct ones
    bool _hasMoreWords = false;
    size_t _count = 0;
    uint32_t _firstLine = 0;
};

}  // namespace limn::engine
