// SPDX-License-Identifier: Apache-2.0
#include "fuzz/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace limn::fuzz {

namespace {

using engine::Scene;

constexpr float kSharpness[] = {0.5f, 1.0f, 1.5f, 2.0f, 2.5f, 4.0f, 8.0f, 10.0f, 0.0f};

void AddFace(Scene& scene, std::initializer_list<Index> vertices) {
    scene.cage.faceSizes.push_back(static_cast<int>(vertices.size()));
    scene.cage.faceVertices.insert(scene.cage.faceVertices.end(), vertices);
}

Index AddVertex(Scene& scene, double x, double y, double z) {
    scene.positions.insert(scene.positions.end(), {x, y, z});
    return scene.cage.numVertices++;
}

/// A point of the unit circle, `k` of `n`.
std::array<double, 2> OnCircle(int k, int n) {
    double const angle = 2.0 * std::numbers::pi * k / n;
    return {std::cos(angle), std::sin(angle)};
}

/// Quads or triangles in a rectangle, whose sides may be joined: a plane, a tube, a torus.
void AddGrid(Choices& choices, Scene& scene) {
    int const columns = choices.TakeInt(1, 6), rows = choices.TakeInt(1, 4);
    bool const isTube = columns > 2 && choices.TakeBool(), isTorus = rows > 2 && choices.TakeBool();
    bool const isTriangular = choices.TakeBool();
    int const width = isTube ? columns : columns + 1, height = isTorus ? rows : rows + 1;
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
            auto const [x, y] = OnCircle(i, columns);
            double const radius = isTorus ? 2.0 + OnCircle(j, rows)[0] : 1.0;
            double const z = isTorus ? OnCircle(j, rows)[1] : j;
            isTube ? AddVertex(scene, radius * x, radius * y, z)
                   : AddVertex(scene, i, isTorus ? OnCircle(j, rows)[0] : j, isTorus ? z : 0.0);
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            auto const at = [&](int x, int y) { return y % height * width + x % width; };
            Index const a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (isTriangular) {
                AddFace(scene, {a, b, c});
                AddFace(scene, {a, c, d});
            } else {
                AddFace(scene, {a, b, c, d});
            }
        }
    }
}

/// n quads between two n-gons; for n = 4 a cube.
void AddPrism(Choices& choices, Scene& scene) {
    int const n = choices.TakeInt(3, 9);
    std::vector<Index> low, high;
    for (int k = 0; k < n; ++k) {
        auto const [x, y] = OnCircle(k, n);
        low.push_back(AddVertex(scene, x, y, -0.7));
        high.push_back(AddVertex(scene, x, y, 0.7));
    }
    for (int k = 0; k < n; ++k) {
        int const next = (k + 1) % n;
        AddFace(scene, {low[k], low[next], high[next], high[k]});
    }
    std::ranges::reverse(low);
    for (auto const& face : {low, high}) {
        scene.cage.faceSizes.push_back(n);
        scene.cage.faceVertices.insert(scene.cage.faceVertices.end(), face.begin(), face.end());
    }
}

/// Triangles round one vertex, or between two: a fan, a disc, a bipyramid (n = 4: an octahedron).
void AddPyramid(Choices& choices, Scene& scene) {
    int const n = choices.TakeInt(3, 20);
    bool const isOpen = choices.TakeBool(), isDouble = choices.TakeBool();
    Index const top = AddVertex(scene, 0.0, 0.0, 1.0);
    Index const bottom = isDouble ? AddVertex(scene, 0.0, 0.0, -1.0) : top;
    Index const first = scene.cage.numVertices;
    for (int k = 0; k < n; ++k) {
        auto const [x, y] = OnCircle(k, n);
        AddVertex(scene, x, y, 0.0);
    }
    for (int k = 0; k < (isOpen ? n - 1 : n); ++k) {
        Index const a = first + k, b = first + (k + 1) % n;
        AddFace(scene, {a, b, top});
        if (isDouble) AddFace(scene, {b, a, bottom});
    }
}

/// Polygons of any vertices: edges of many faces, faces that repeat a corner, loose vertices.
void AddPolygons(Choices& choices, Scene& scene) {
    int const numVertices = choices.TakeInt(3, 12), numFaces = choices.TakeInt(1, 12);
    for (int i = 0; i < numVertices; ++i) {
        double const x = choices.TakeSigned(), y = choices.TakeSigned(), z = choices.TakeSigned();
        AddVertex(scene, x, y, z);
    }
    for (int face = 0; face < numFaces; ++face) {
        int const size = choices.Pick({3, 4, 3, 4, 5, 6, 9});
        scene.cage.faceSizes.push_back(size);
        for (int i = 0; i < size; ++i)
            scene.cage.faceVertices.push_back(choices.TakeInt(0, numVertices - 1));
    }
}

Index ChooseVertex(Choices& choices, Scene const& scene) {
    return choices.TakeInt(0, scene.cage.numVertices - 1);
}

Index ChooseFace(Choices& choices, Scene const& scene) {
    return choices.TakeInt(0, scene.cage.GetNumFaces() - 1);
}

/// The place of a face's first corner among all.
size_t FindFirstCorner(Scene const& scene, Index face) {
    size_t corner = 0;
    for (Index before = 0; before < face; ++before) corner += scene.cage.faceSizes[before];
    return corner;
}

void MoveVertex(Choices& choices, Scene& scene) {
    Index const vertex = ChooseVertex(choices, scene);
    for (int c = 0; c < 3; ++c) scene.positions[3 * vertex + c] += choices.TakeSigned();
}

/// A vertex to where another is: an edge without length, coincident sheets.
void CollapseVertex(Choices& choices, Scene& scene) {
    Index const from = ChooseVertex(choices, scene), to = ChooseVertex(choices, scene);
    std::copy_n(&scene.positions[3 * to], 3, &scene.positions[3 * from]);
}

void TurnFace(Choices& choices, Scene& scene) {
    Index const face = ChooseFace(choices, scene);
    auto const first = scene.cage.faceVertices.begin() + FindFirstCorner(scene, face);
    std::reverse(first, first + scene.cage.faceSizes[face]);
}

void RemoveFace(Choices& choices, Scene& scene) {
    if (scene.cage.GetNumFaces() < 2) return;
    Index const face = ChooseFace(choices, scene);
    auto const first = scene.cage.faceVertices.begin() + FindFirstCorner(scene, face);
    scene.cage.faceVertices.erase(first, first + scene.cage.faceSizes[face]);
    scene.cage.faceSizes.erase(scene.cage.faceSizes.begin() + face);
}

/// A corner to another vertex, which tears and joins.
void MoveCorner(Choices& choices, Scene& scene) {
    Index const face = ChooseFace(choices, scene);
    int const corner = choices.TakeInt(0, scene.cage.faceSizes[face] - 1);
    Index const vertex = ChooseVertex(choices, scene);
    scene.cage.faceVertices[FindFirstCorner(scene, face) + corner] = vertex;
}

void AddCrease(Choices& choices, Scene& scene) {
    Index const face = ChooseFace(choices, scene);
    int const size = scene.cage.faceSizes[face], corner = choices.TakeInt(0, size - 1);
    Index const* const vertices = &scene.cage.faceVertices[FindFirstCorner(scene, face)];
    scene.cage.creaseVertexPairs.insert(scene.cage.creaseVertexPairs.end(),
                                        {vertices[corner], vertices[(corner + 1) % size]});
    scene.cage.creaseSharpness.push_back(choices.Pick(kSharpness));
}

void AddCorner(Choices& choices, Scene& scene) {
    scene.cage.cornerVertices.push_back(ChooseVertex(choices, scene));
    scene.cage.cornerSharpness.push_back(choices.Pick(kSharpness));
}

void AddHole(Choices& choices, Scene& scene) {
    scene.cage.holes.push_back(ChooseFace(choices, scene));
}

void ChangeSome(Choices& choices, Scene& scene) {
    static constexpr void (*kChanges[])(Choices&, Scene&) = {
        MoveVertex, AddCrease, AddCorner,  AddHole,        MoveVertex,
        TurnFace,   AddCrease, RemoveFace, CollapseVertex, MoveCorner};
    for (int count = choices.TakeInt(0, 12); count > 0; --count)
        choices.Pick(kChanges)(choices, scene);
}

/// Sizes and places that are far from one and the origin; exact, so that planes stay planes.
void ChooseFrame(Choices& choices, Scene& scene) {
    double const scale = choices.Pick({1.0, 1.0, 1.0, 1e-3, 1e3, 1e-9, 1e9, 0.0});
    double const offset = choices.Pick({0.0, 0.0, 0.0, 0.0, 10.0, 1e4, 1e6});
    for (double& coordinate : scene.positions) coordinate = coordinate * scale + offset * scale;
}

/// The texture coordinates of a face's corner.
std::array<double, 2> MakeUV(Choices& choices, Scene const& scene, int rule, Index face, int i,
                             Index vertex) {
    double const* const p = &scene.positions[3 * vertex];
    switch (rule) {
        case 1: {  // a chart per face, side by side
            auto const [u, v] = OnCircle(i, scene.cage.faceSizes[face]);
            return {(face % 8 + 0.5 + 0.45 * u) / 8, (face / 8 + 0.5 + 0.45 * v) / 8};
        }
        case 2:  // laid over the plane, may be folded
            return {0.25 + 0.125 * p[0], 0.25 + 0.125 * p[1]};
        case 3:  // the same chart for all, of this or that tile
            return {(face % 2) + (i == 1 || i == 2 ? 0.9 : 0.1), i >= 2 ? 0.9 : 0.1};
        default:
            return {0.5 + choices.TakeSigned(), 0.5 + choices.TakeSigned()};
    }
}

void AddUVs(Choices& choices, Scene& scene) {
    int const rule = choices.TakeInt(0, 4);
    if (rule == 0) return;
    bool const isShared = choices.TakeBool(), isPartial = choices.TakeOneIn(4);
    std::vector<Index> values;
    std::vector<char> lacks;
    std::vector<Index> valueOfVertex(scene.cage.numVertices, -1);
    size_t corner = 0;
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
        bool const isLeftOut = isPartial && face > 0 && choices.TakeBool();
        lacks.push_back(isLeftOut);
        for (int i = 0; i < scene.cage.faceSizes[face]; ++i, ++corner) {
            Index const vertex = scene.cage.faceVertices[corner];
            Index value = isShared ? valueOfVertex[vertex] : -1;
            if (!isLeftOut && value < 0) {
                value = static_cast<Index>(scene.uvs.size() / 2);
                auto const uv = MakeUV(choices, scene, rule, face, i, vertex);
                scene.uvs.insert(scene.uvs.end(), uv.begin(), uv.end());
                valueOfVertex[vertex] = value;
            }
            values.push_back(isLeftOut ? -1 : value);
        }
    }
    if (std::ranges::find(lacks, 1) == lacks.end()) lacks.clear();
    scene.AddUVChannel(std::move(values), std::move(lacks));
}

void AddGroups(Choices& choices, Scene& scene) {
    if (!choices.TakeOneIn(4)) return;
    auto& groups = scene.groups[static_cast<size_t>(engine::GroupKind::Material)];
    groups.names = {"skin", "cloth"};
    for (size_t face = 0; face < scene.cage.faceSizes.size(); ++face)
        groups.faceGroup.push_back(choices.TakeInt(-1, 1));
}

void AddPrimvar(Choices& choices, Scene& scene) {
    if (!choices.TakeOneIn(4)) return;
    engine::Primvar primvar{"color", 3, {}};
    for (Index i = 0; i < 3 * scene.cage.numVertices; ++i)
        primvar.values.push_back(static_cast<float>(choices.TakeShare()));
    scene.primvars.push_back(std::move(primvar));
}

void ChooseRules(Choices& choices, far_ext::ControlMesh& cage) {
    bool const isTriangular = std::ranges::all_of(cage.faceSizes, [](int n) { return n == 3; });
    cage.scheme = choices.Pick({isTriangular ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK,
                                Sdc::SCHEME_CATMARK, Sdc::SCHEME_BILINEAR});
    using Options = Sdc::Options;
    cage.options.SetVtxBoundaryInterpolation(
        choices.Pick({Options::VTX_BOUNDARY_EDGE_AND_CORNER, Options::VTX_BOUNDARY_EDGE_ONLY,
                      Options::VTX_BOUNDARY_NONE}));
    cage.options.SetFVarLinearInterpolation(
        choices.Pick({Options::FVAR_LINEAR_CORNERS_PLUS1, Options::FVAR_LINEAR_CORNERS_PLUS2,
                      Options::FVAR_LINEAR_CORNERS_ONLY, Options::FVAR_LINEAR_BOUNDARIES,
                      Options::FVAR_LINEAR_ALL, Options::FVAR_LINEAR_NONE}));
    cage.options.SetCreasingMethod(
        choices.Pick({Options::CREASE_UNIFORM, Options::CREASE_CHAIKIN}));
    cage.options.SetTriangleSubdivision(
        choices.Pick({Options::TRI_SUB_CATMARK, Options::TRI_SUB_SMOOTH}));
}

}  // namespace

Scene ChooseMesh(Choices& choices) {
    Scene scene;
    scene.path = scene.name = "mesh";
    static constexpr void (*kShapes[])(Choices&, Scene&) = {AddGrid, AddPrism, AddPyramid,
                                                            AddPolygons};
    choices.Pick(kShapes)(choices, scene);
    ChooseRules(choices, scene.cage);
    ChangeSome(choices, scene);
    AddUVs(choices, scene);  // laid over the shape as it is near the origin
    ChooseFrame(choices, scene);
    AddGroups(choices, scene);
    AddPrimvar(choices, scene);
    return scene;
}

}  // namespace limn::fuzz
