// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/udim.h"

namespace limn::engine {

namespace {

constexpr char const* kTokens[] = {"<UDIM>", "{udim}"};

}  // namespace

std::string ReplaceAll(std::string text, std::string const& token, std::string const& value) {
    for (size_t at = text.find(token); at != std::string::npos;
         at = text.find(token, at + value.size())) {
        text.replace(at, token.size(), value);
    }
    return text;
}

bool HasUdimToken(std::string const& pattern) {
    for (char const* token : kTokens) {
        if (pattern.find(token) != std::string::npos) return true;
    }
    return false;
}

std::string ReplaceUdimToken(std::string pattern, int number) {
    for (char const* token : kTokens) {
        pattern = ReplaceAll(std::move(pattern), token, std::to_string(number));
    }
    return pattern;
}

}  // namespace limn::engine
