// SPDX-License-Identifier: Apache-2.0
#include "engine/io/file_kind.h"

#include <bit>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "engine/io/text_scanner.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

using namespace std::string_view_literals;

/// Bytes that a kind of file begins with.
struct Beginning {
    std::string_view bytes;
    std::string_view kind;
};

constexpr Beginning kBeginnings[] = {
    // scenes and meshes
    {"#usda"sv, "USD"sv},
    {"PXR-USDC"sv, "USD (binary)"sv},
    {"glTF"sv, "glTF (binary)"sv},
    {"Kaydara FBX Binary"sv, "FBX"sv},
    {"; FBX"sv, "FBX (text)"sv},
    {"Ogawa"sv, "Alembic"sv},
    {"\x89HDF\r\n"sv, "HDF5 (Alembic?)"sv},
    {"BLENDER"sv, "a scene of Blender"sv},
    {"//Maya ASCII"sv, "a scene of Maya"sv},
    {"FOR4"sv, "a scene of Maya (binary)"sv},
    {"FOR8"sv, "a scene of Maya (binary)"sv},
    {"FORM"sv, "IFF (LightWave?)"sv},
    {"\x7fNSJ"sv, "geometry of Houdini"sv},
    {"#VRML"sv, "VRML"sv},
    {"# vtk DataFile"sv, "VTK"sv},
    {"MeshVersionFormatted"sv, "Medit"sv},
    {"$MeshFormat"sv, "Gmsh"sv},
    {"ISO-10303-21"sv, "STEP"sv},
    {"DRACO"sv, "Draco"sv},
    {"MM\0\x2a"sv, "an image (TIFF)"sv},
    // images
    {"\x76\x2f\x31\x01"sv, "an image (OpenEXR)"sv},
    {"\x89PNG\r\n"sv, "an image (PNG)"sv},
    {"\xff\xd8\xff"sv, "an image (JPEG)"sv},
    {"II\x2a\0"sv, "an image (TIFF)"sv},
    {"#?RADIANCE"sv, "an image (HDR)"sv},
    // what holds other files
    {"\x1f\x8b"sv, "gzip; unpack it first"sv},
    {"BZh"sv, "bzip2; unpack it first"sv},
    {"\xfd\x37zXZ"sv, "xz; unpack it first"sv},
    {"\x28\xb5\x2f\xfd"sv, "zstd; unpack it first"sv},
    {"7z\xbc\xaf"sv, "7-Zip; unpack it first"sv},
    {"PK\x03\x04"sv, "ZIP (USDZ, 3MF, a spreadsheet?)"sv},
    // what stands where a file should be
    {"version https://git-lfs"sv, "a Git LFS pointer; fetch the file itself"sv},
    {"%PDF"sv, "PDF"sv},
    {"\x7f"
     "ELF"sv,
     "a program"sv},
};

bool Has(std::string_view text, std::string_view word) {
    return text.find(word) != std::string_view::npos;
}

/// 80 bytes of anything, a count, and 50 bytes per triangle; text would count hundreds of millions.
bool IsBinaryStl(std::string_view bytes) {
    constexpr size_t kHeader = 84, kTriangle = 50;
    if (bytes.size() < kHeader + kTriangle) return false;
    uint32_t count = 0;
    static_assert(std::endian::native == std::endian::little);
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return bytes.size() == kHeader + kTriangle * static_cast<size_t>(count);
}

/// By the first character that no text limn reads begins with.
std::string_view RecogniseMarkup(std::string_view head) {
    size_t const first = head.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return {};
    switch (head[first]) {
        case '<':
            if (Has(head, "<COLLADA")) return "COLLADA";
            if (Has(head, "<X3D")) return "X3D";
            if (Has(head, "<html") || Has(head, "<HTML") || Has(head, "<!DOCTYPE"))
                return "a web page";
            return "XML";
        case '{':
            return Has(head, "\"asset\"") ? "glTF" : "JSON";
        case '[':
            return Has(head, "\"fileversion\"") ? "geometry of Houdini" : "JSON";
        default:
            return {};
    }
}

}  // namespace

std::string_view RecogniseForeignFile(std::string_view bytes) {
    std::string_view const unmarked = TextScanner::WithoutMark(bytes);
    for (Beginning const& beginning : kBeginnings) {
        if (unmarked.starts_with(beginning.bytes)) return beginning.kind;
    }
    constexpr size_t kHead = 4096;  // where words that tell a text's kind stand
    std::string_view const head = unmarked.substr(0, kHead);
    if (head.starts_with("solid") && Has(head, "facet")) return "STL (text)";
    if (IsBinaryStl(bytes)) return "STL";
    return RecogniseMarkup(head);
}

void RefuseForeignFile(std::string_view bytes, std::string const& path, char const* wanted) {
    std::string_view const kind = RecogniseForeignFile(bytes);
    if (kind.empty()) return;
    throw Error(ErrorCode::BadMesh,
                fmt::format("{}: looks like {}: {} is needed", path, kind, wanted));
}

}  // namespace limn::engine
