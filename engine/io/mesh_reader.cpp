// SPDX-License-Identifier: Apache-2.0
#include "engine/io/mesh_reader.h"

#include <filesystem>

#include <fmt/format.h>

#include "engine/io/file.h"
#include "engine/io/obj_reader.h"
#include "engine/io/off_reader.h"
#include "engine/io/ply_reader.h"
#include "far_ext/error.h"

namespace limn::engine {

Scene ReadMesh(std::string const& path) {
    InputFile const file(path);
    std::string_view const bytes = file.GetBytes();
    Scene scene;
    scene.path = path;
    scene.name = std::filesystem::path(path).stem().string();
    scene.sha256 = Sha256(bytes);
    if (bytes.empty()) throw Error(ErrorCode::BadMesh, fmt::format("{}: the file is empty", path));
    std::string const ending = GetEnding(path);
    if (ending == ".ply" || (ending != ".obj" && bytes.starts_with("ply")))
        ReadPly(bytes, scene);
    else if (ending == ".off" || (ending != ".obj" && bytes.starts_with("OFF")))
        ReadOff(bytes, scene);
    else
        ReadObj(bytes, scene);
    return scene;
}

}  // namespace limn::engine
