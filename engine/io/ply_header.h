// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/io/text_scanner.h"

namespace limn::engine {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

constexpr size_t SizeOf(PlyType type) {
    constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<int>(type)];
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> countType{};  ///< of a list
};

struct PlyElement {
    std::string name;
    size_t count = 0;
    std::vector<PlyProperty> properties{};

    bool Has(std::string_view property) const;
};

/// What a PLY file says of itself before its values.
struct PlyHeader {
    enum class Format { Text, LittleEndian, BigEndian };

    Format format = Format::Text;
    std::vector<PlyElement> elements;       ///< in the order of their values
    std::vector<std::string> textureFiles;  ///< of "comment TextureFile NAME" lines

    /// Nothing where there is no such element.
    PlyElement const* Find(std::string_view element) const;
};

/// Reads a header up to its last line, on which the scanner stays.
///
/// \throws Error  BadMesh, as "FILE:LINE: ..."
PlyHeader ReadPlyHeader(TextScanner& scan);

}  // namespace limn::engine
