// SPDX-License-Identifier: Apache-2.0
#include "engine/io/mesh_reader.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include "engine/io/file.h"
#include "engine/io/file_kind.h"
#include "engine/io/obj_reader.h"
#include "engine/io/off_reader.h"
#include "engine/io/ply_reader.h"
#include "engine/scene/sha256.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

/// A format that limn reads: its ending, how its files are known, and who reads them.
struct MeshFormat {
    std::string_view name, ending;
    bool (*isOfBytes)(std::string_view bytes);
    void (*read)(std::string_view bytes, Scene& scene);
};

constexpr MeshFormat kFormats[] = {
    {"PLY", ".ply", IsPly, ReadPly},
    {"OFF", ".off", IsOff, ReadOff},
    {"OBJ", ".obj", [](std::string_view) { return true; }, ReadObj},  // begins with anything
};

/// By the file's ending or, failing that, its first bytes, which must not contradict.
MeshFormat const& ChooseFormat(std::string const& path, std::string_view bytes) {
    MeshFormat const& ofBytes = *std::ranges::find_if(
        kFormats, [&](MeshFormat const& format) { return format.isOfBytes(bytes); });
    auto const ofEnding = std::ranges::find(kFormats, GetEnding(path), &MeshFormat::ending);
    if (ofEnding == std::end(kFormats)) return ofBytes;
    if (&ofBytes != ofEnding && ofBytes.name != "OBJ") {
        throw Error(ErrorCode::BadMesh, fmt::format("{}: looks like {}: rename it to {}", path,
                                                    ofBytes.name, ofBytes.ending));
    }
    return *ofEnding;
}

}  // namespace

Scene ReadMesh(std::string const& path) {
    InputFile const file(path);
    return ParseMesh(path, file.GetBytes());
}

Scene ParseMesh(std::string const& path, std::string_view bytes) {
    if (bytes.empty()) throw Error(ErrorCode::BadMesh, fmt::format("{}: the file is empty", path));
    RefuseForeignFile(bytes, path, "OBJ, PLY or OFF");
    MeshFormat const& format = ChooseFormat(path, bytes);
    Scene scene;
    scene.path = path;
    scene.name = std::filesystem::path(path).stem().string();
    scene.sha256 = Sha256(bytes);
    format.read(bytes, scene);
    return scene;
}

}  // namespace limn::engine
