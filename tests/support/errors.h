// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "far_ext/error.h"

namespace limn::test {

/// The Error that `act` throws, if it throws one.
template <class Act>
std::optional<Error> CatchError(Act act) {
    try {
        act();
    } catch (Error const& error) {
        return error;
    }
    return {};
}

/// Its message; empty if there is none.
template <class Act>
std::string RefusalOf(Act act) {
    auto const error = CatchError(act);
    return error ? error->what() : "";
}

/// Its code, if there is one.
template <class Act>
std::optional<ErrorCode> CodeOf(Act act) {
    auto const error = CatchError(act);
    return error ? std::optional(error->GetCode()) : std::nullopt;
}

}  // namespace limn::test
