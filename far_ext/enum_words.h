// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// \throws Error  BadOption: "`member`: 'word' is not one of a, b, c"
[[noreturn]] void ThrowUnknownWord(char const* member, std::string_view word,
                                   std::vector<std::string> const& known);

/// "a, b, c"
std::string JoinWords(std::vector<std::string> const& words);

/// A value of an option, and its word on the command line, in reports and in messages.
template <class Value>
struct EnumWord {
    Value value;
    char const* word;
};

/// All values of an option and their words, in the order in which they are told.
template <class Value, size_t N>
struct EnumWords {
    char const* member;  ///< the option's, for messages
    std::array<EnumWord<Value>, N> rows;

    /// "unknown" for a value that has no row.
    constexpr char const* GetWord(Value const& value) const {
        for (auto const& row : rows) {
            if (row.value == value) return row.word;
        }
        return "unknown";
    }

    constexpr std::optional<Value> Find(std::string_view word) const {
        for (auto const& row : rows) {
            if (row.word == word) return row.value;
        }
        return std::nullopt;
    }

    /// \throws Error  as ThrowUnknownWord
    Value Parse(std::string_view word) const {
        if (auto const value = Find(word)) return *value;
        ThrowUnknownWord(member, word, List());
    }

    std::vector<std::string> List() const {
        std::vector<std::string> words;
        for (auto const& row : rows) words.emplace_back(row.word);
        return words;
    }
};

/// E.g. MakeEnumWords<Side>("side", {{Side::Left, "left"}, {Side::Right, "right"}}).
template <class Value, size_t N>
constexpr EnumWords<Value, N> MakeEnumWords(char const* member, EnumWord<Value> const (&rows)[N]) {
    EnumWords<Value, N> words{member, {}};
    for (size_t i = 0; i < N; ++i) words.rows[i] = rows[i];
    return words;
}

}  // namespace limn
