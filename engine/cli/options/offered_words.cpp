// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/offered_words.h"

#include "engine/bake/maps/map_table.h"

namespace limn::cli {

OfferedWords FindOfferedWords(std::string_view longFlag) {
    if (longFlag == "--preview-range") return {{"p1", "full", "asinh"}};
    if (longFlag == "--origin") return {{"auto"}};
    if (longFlag == "--half") return {engine::ListFixedMapNames(), /*isList=*/true};
    return {};
}

}  // namespace limn::cli
