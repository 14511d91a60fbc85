// SPDX-License-Identifier: Apache-2.0
#include "support/meshes.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>

#include "engine/io/mesh_reader.h"

namespace limn::test {

namespace fs = std::filesystem;

std::string DataPath(std::string const& path) {
    return std::string(LIMN_TEST_DATA) + "/" + path;
}

std::string ScenePath(std::string const& path) {
    return std::string(LIMN_SOURCE_DIR) + "/scenes/" + path;
}

engine::Scene LoadData(std::string const& path) {
    return engine::ReadMesh(DataPath(path));
}

std::vector<double> LoadPoints(std::string const& path) {
    std::ifstream file(DataPath(path));
    std::vector<double> values;
    for (std::string word; file >> word;) {
        if (word != "v") {
            file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
            continue;
        }
        for (int c = 0; c < 3; ++c) file >> values.emplace_back();
    }
    if (values.empty()) throw std::runtime_error("no points in " + path);
    return values;
}

engine::Scene LoadShape(std::string const& name) {
    engine::Scene scene = LoadData("opensubdiv_shapes/" + name + ".obj");
    scene.cage.scheme = name.starts_with("loop")       ? Sdc::SCHEME_LOOP
                        : name.starts_with("bilinear") ? Sdc::SCHEME_BILINEAR
                                                       : Sdc::SCHEME_CATMARK;
    return scene;
}

std::string AssetPath(std::string const& path) {
    std::string own = DataPath("assets/" + path);
#ifdef LIMN_ASSETS
    if (!fs::exists(own)) return std::string(LIMN_ASSETS) + "/" + path;
#endif
    return own;
}

bool HasAsset(std::string const& path) {
    return fs::exists(AssetPath(path));
}

engine::Scene LoadAsset(std::string const& path) {
    return engine::ReadMesh(AssetPath(path));
}

engine::Scene LoadSpot() {
    return engine::ReadMesh(ScenePath("spot/spot.obj"));
}

std::vector<std::string> ListData(std::string const& folder) {
    std::vector<std::string> names;
    for (auto const& entry : fs::directory_iterator(DataPath(folder))) {
        if (entry.path().extension() == ".obj") names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> ListShapes() {
    auto names = ListData("opensubdiv_shapes");
    for (std::string& name : names) name = fs::path(name).stem();
    return names;
}

std::string NameInstance(std::string const& path) {
    std::string name = fs::path(path).stem();
    for (char& c : name) {
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    }
    return name;
}

engine::Scene MakeScene(std::vector<double> positions, std::vector<std::vector<Index>> const& faces,
                        Sdc::SchemeType scheme) {
    engine::Scene scene;
    scene.path = scene.name = "made";
    scene.cage.numVertices = static_cast<Index>(positions.size() / 3);
    scene.cage.scheme = scheme;
    for (auto const& face : faces) {
        scene.cage.faceSizes.push_back(static_cast<int>(face.size()));
        scene.cage.faceVertices.insert(scene.cage.faceVertices.end(), face.begin(), face.end());
    }
    scene.positions = std::move(positions);
    return scene;
}

engine::Scene MakeFan(int valence, Sdc::SchemeType scheme, double a, double b) {
    constexpr int kRings = 3;
    bool const isLoop = scheme == Sdc::SCHEME_LOOP;
    std::vector<double> positions;
    std::map<std::vector<int>, Index> vertices;
    double const pi = std::acos(-1.0);
    // Sector k spans directions k and k + 1; place (i, j) is i steps along one, j along the other.
    auto const vertex = [&](int sector, int i, int j) {
        std::vector<int> key;
        if (i == 0 && j == 0)
            key = {0};
        else if (i == 0)
            key = {1, (sector + 1) % valence, j};
        else if (j == 0)
            key = {1, sector, i};
        else
            key = {2, sector, i, j};
        auto const [found, isNew] =
            vertices.try_emplace(key, static_cast<Index>(positions.size() / 3));
        if (isNew) {
            double const u = 2 * pi * sector / valence, v = 2 * pi * (sector + 1) / valence;
            double const x = i * std::cos(u) + j * std::cos(v),
                         y = i * std::sin(u) + j * std::sin(v);
            positions.insert(positions.end(), {x, y, a * (x * x + y * y) + b * (x * x - y * y)});
        }
        return found->second;
    };
    vertex(0, 0, 0);
    std::vector<std::vector<Index>> faces;
    for (int k = 0; k < valence; ++k) {
        for (int i = 0; i < kRings; ++i) {
            for (int j = 0; j < kRings; ++j) {
                Index const p = vertex(k, i, j), q = vertex(k, i + 1, j), r = vertex(k, i, j + 1);
                if (!isLoop) {
                    faces.push_back({p, q, vertex(k, i + 1, j + 1), r});
                } else if (i + j < kRings) {
                    faces.push_back({p, q, r});
                    if (i + j + 1 < kRings) faces.push_back({q, vertex(k, i + 1, j + 1), r});
                }
            }
        }
    }
    return MakeScene(std::move(positions), faces, scheme);
}

namespace {

std::vector<double> TorusPositions(int n, int m) {
    std::vector<double> positions;
    double const pi = std::acos(-1.0);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            double const a = 2 * pi * i / n, b = 2 * pi * j / m;
            double const r = 0.4 * (1 + 0.1 * std::sin(5 * a + 3 * b));
            positions.insert(positions.end(),
                             {(1 + r * std::cos(b)) * std::cos(a),
                              (1 + r * std::cos(b)) * std::sin(a), r * std::sin(b)});
        }
    }
    return positions;
}

}  // namespace

engine::Scene MakeTorus(int n, int m) {
    std::vector<std::vector<Index>> faces;
    std::vector<double> uvs;
    std::vector<Index> uvIndices;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            uvs.insert(uvs.end(), {static_cast<double>(i) / n, static_cast<double>(j) / m});
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            int const i1 = (i + 1) % n, j1 = (j + 1) % m;
            faces.push_back({i * m + j, i1 * m + j, i1 * m + j1, i * m + j1});
            for (auto const& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
                uvIndices.push_back(a * (m + 1) + b);
            }
        }
    }
    engine::Scene scene = MakeScene(TorusPositions(n, m), faces);
    scene.cage.fvarChannels.push_back({static_cast<Index>(uvs.size() / 2), std::move(uvIndices)});
    scene.uvs = std::move(uvs);
    return scene;
}

engine::Scene MakeTriangleTorus(int n, int m) {
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            int const i1 = (i + 1) % n, j1 = (j + 1) % m;
            faces.push_back({i * m + j, i1 * m + j, i1 * m + j1});
            faces.push_back({i * m + j, i1 * m + j1, i * m + j1});
        }
    }
    return MakeScene(TorusPositions(n, m), faces, Sdc::SCHEME_LOOP);
}

engine::Scene MakeCube() {
    return MakeScene(
        {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1},
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

}  // namespace limn::test
