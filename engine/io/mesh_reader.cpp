#include "engine/io/mesh_reader.h"

#include <filesystem>

#include <fmt/format.h>

#include "engine/io/file.h"
#include "engine/io/obj_reader.h"
#include "far_ext/error.h"

namespace limn::engine {

Scene ReadMesh(std::string const& path) {
    InputFile const file(path);
    Scene scene;
    scene.path = path;
    scene.name = std::filesystem::path(path).stem().string();
    scene.sha256 = Sha256(file.GetBytes());
    ReadObj(file.GetBytes(), scene);
    return scene;
}

}  // namespace limn::engine
