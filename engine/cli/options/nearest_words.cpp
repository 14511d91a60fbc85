// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/nearest_words.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limn::cli {

namespace {

/// Edits from one word to the other, by rows of the table of their beginnings (optimal string
/// alignment: no letter is edited twice).
size_t CountEdits(std::string_view a, std::string_view b) {
    std::vector<size_t> before, last(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        before = last;
        last = row;
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            bool const isSwap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (isSwap) row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

std::string ToLower(std::string_view word) {
    std::string lower(word);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

/// The letters of an option or a verb.
std::string_view WithoutDashes(std::string_view word) {
    return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

constexpr size_t kTooFar = 1000;

size_t FindDistance(std::string_view word, std::string_view known) {
    bool const isBeginning = word.size() > 1 && known.starts_with(word);
    size_t const numEdits = CountEdits(word, known), most = std::max<size_t>(1, word.size() / 3);
    if (isBeginning) return std::min<size_t>(numEdits, 1);
    return numEdits <= most ? numEdits : kTooFar;
}

}  // namespace

std::vector<std::string> FindNearestWords(std::string_view word,
                                          std::vector<std::string> const& known) {
    std::string const lower = ToLower(word);
    size_t least = kTooFar;
    std::vector<std::string> nearest;
    for (std::string const& candidate : known) {
        size_t const distance = FindDistance(WithoutDashes(lower), WithoutDashes(candidate));
        if (distance < least) nearest.clear();
        least = std::min(least, distance);
        if (distance == least && distance < kTooFar) nearest.push_back(candidate);
    }
    return nearest;
}

std::string AskForNearest(std::string_view word, std::vector<std::string> const& known) {
    auto const nearest = FindNearestWords(word, known);
    return nearest.empty() ? "" : fmt::format("; did you mean {}?", fmt::join(nearest, " or "));
}

}  // namespace limn::cli
