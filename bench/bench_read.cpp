// SPDX-License-Identifier: Apache-2.0
//
// Reading meshes: OBJ against tinyobjloader, and binary PLY beside them in bytes per second. Both
// read the whole file and keep what they made of it: limn in double, with a hash of the bytes and
// the line of every face; tinyobjloader in float.

#include "engine/io/mesh_reader.h"
#include "harness.h"
#include "heap_peak.h"
#include "peers/tinyobj_reader.h"
#include "support/meshes.h"

namespace limn::bench {
namespace {

/// The same vertices, faces and corners, in the same order where the file has one shape.
void CheckObj(std::string const& path) {
    engine::Scene const scene = engine::ReadMesh(path);
    TinyObj const peer(path);
    auto const& vertices = peer.reader.GetAttrib().vertices;
    Check(vertices.size() == scene.positions.size(),
          "another number of vertices than tinyobjloader's");
    Check(peer.GetNumFaces() == scene.cage.faceSizes.size(),
          "another number of faces than tinyobjloader's");
    Check(peer.GetNumCorners() == scene.cage.faceVertices.size(),
          "another number of corners than tinyobjloader's");
    for (size_t i = 0; i < vertices.size(); ++i) {
        double const allowed = 1e-6 * std::max(1.0, std::abs(scene.positions[i]));
        Check(std::abs(vertices[i] - scene.positions[i]) <= allowed,
              "a position differs from tinyobjloader's");
    }
    if (peer.reader.GetShapes().size() != 1) return;
    auto const& indices = peer.reader.GetShapes()[0].mesh.indices;
    for (size_t i = 0; i < indices.size(); ++i) {
        Check(indices[i].vertex_index == scene.cage.faceVertices[i],
              "a corner differs from tinyobjloader's");
    }
}

struct File {
    std::string name, path;
    bool isObj;
    double bytes;
};

void Measure(File const& file, int numRounds) {
    if (file.isObj) CheckObj(file.path);
    fmt::print("\n{}, {:.2f} MB\n", file.name, file.bytes * 1e-6);
    double const ownPeak = MeasureHeapPeak([&] { engine::ReadMesh(file.path); });
    double const peerPeak =
        file.isObj ? MeasureHeapPeak([&] { TinyObj const read(file.path); }) : 0.0;
    Rounds rounds(numRounds);
    size_t const limn = rounds.Add("limn", [&] { engine::ReadMesh(file.path); }, file.bytes);
    size_t peer = 0;
    if (file.isObj)
        peer = rounds.Add("tinyobjloader", [&] { TinyObj const read(file.path); }, file.bytes);
    rounds.Run("bytes");
    if (!file.isObj) {
        fmt::print("  peak heap: limn {:.2f} MiB\n", ownPeak);
        return;
    }
    rounds.Compare("limn against tinyobjloader", limn, peer, 1.0);
    double const ratio = ownPeak / peerPeak;
    fmt::print(
        "  => peak heap: limn {:.2f} MiB, tinyobjloader {:.2f} MiB, ratio {:.2f}, target below 1: "
        "{}\n",
        ownPeak, peerPeak, ratio, ratio < 1.0 ? "reached" : "MISSED");
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    using namespace limn;
    int const numRounds = bench::GetNumRounds(argc, argv);
    for (char const* name : {"control/ict_face_neutral.obj", "control/chess_rook.obj",
                             "large/koala_100k.obj", "large/koala_400k.ply"}) {
        std::string const path = test::AssetPath(name);
        if (!test::HasAsset(name)) {
            fmt::print("skipped: there is no {}\n", path);
            continue;
        }
        bench::Measure({name, path, path.ends_with(".obj"),
                        static_cast<double>(std::filesystem::file_size(path))},
                       numRounds);
    }
    return 0;
}
