// SPDX-License-Identifier: Apache-2.0
#include "engine/io/mesh_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "engine/io/file.h"
#include "engine/scene/scene_checks.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

/// The shortest digits that read back as the same number.
void AppendNumber(fmt::memory_buffer& to, double value, Precision precision) {
    if (precision == Precision::Double)
        fmt::format_to(std::back_inserter(to), "{}", value);
    else
        fmt::format_to(std::back_inserter(to), "{}", static_cast<float>(value));
}

void Append(fmt::memory_buffer& to, std::string_view text) {
    to.append(text.data(), text.data() + text.size());
}

/// The colours that OBJ can hold behind positions, or null.
Primvar const* FindObjColours(Scene const& scene) {
    auto const found = std::ranges::find_if(scene.primvars, [](Primvar const& primvar) {
        return primvar.name == "color" && (primvar.numChannels == 3 || primvar.numChannels == 4);
    });
    return found == scene.primvars.end() ? nullptr : &*found;
}

class ObjText {
public:
    ObjText(Scene const& scene, Precision precision) : _scene(scene), _precision(precision) {}

    std::string Make() {
        AppendVertices();
        AppendUVs();
        AppendRows("vn", _scene.normals, 3);
        AppendFaces();
        AppendTags();
        return fmt::to_string(_text);
    }

private:
    void AppendRows(char const* keyword, std::vector<double> const& values, size_t length) {
        for (size_t i = 0; i < values.size(); i += length) {
            Append(_text, keyword);
            for (size_t c = 0; c < length; ++c) {
                _text.push_back(' ');
                AppendNumber(_text, values[i + c], _precision);
            }
            _text.push_back('\n');
        }
    }

    /// Positions, with colours behind them where the mesh has any.
    void AppendVertices() {
        Primvar const* const colours = FindObjColours(_scene);
        if (!colours) return AppendRows("v", _scene.positions, 3);
        far_ext::Points const points(_scene.positions);
        size_t const n = static_cast<size_t>(colours->numChannels);
        for (size_t vertex = 0; vertex < points.GetCount(); ++vertex) {
            _text.push_back('v');
            for (double coordinate : points[vertex]) {
                _text.push_back(' ');
                AppendNumber(_text, coordinate, _precision);
            }
            for (size_t c = 0; c < n; ++c)
                fmt::format_to(std::back_inserter(_text), " {}", colours->values[vertex * n + c]);
            _text.push_back('\n');
        }
    }

    /// The values that faces use, without what stands for none.
    void AppendUVs() {
        if (_scene.lacksUVs.empty()) return AppendRows("vt", _scene.uvs, 2);
        auto const& cage = _scene.cage;
        std::vector<double> uvs;
        _uvNumbers.assign(_scene.uvs.size() / 2, 0);
        size_t corner = 0;
        for (Index face = 0; face < cage.GetNumFaces(); ++face) {
            for (int i = 0; i < cage.faceSizes[face]; ++i, ++corner) {
                Index const value = cage.fvarChannels[0].valueIndices[corner];
                if (!_scene.HasUVs(face) || _uvNumbers[value] != 0) continue;
                uvs.insert(uvs.end(), {_scene.uvs[2 * value], _scene.uvs[2 * value + 1]});
                _uvNumbers[value] = static_cast<Index>(uvs.size() / 2);
            }
        }
        AppendRows("vt", uvs, 2);
    }

    Index GetUVNumber(Index value) const {
        return _uvNumbers.empty() ? value + 1 : _uvNumbers[value];
    }

    void AppendFaces() {
        auto const& cage = _scene.cage;
        Index current[3] = {-1, -1, -1};
        static char const* const kKeywords[3] = {"usemtl", "g", "o"};
        size_t corner = 0;
        for (Index face = 0; face < cage.GetNumFaces(); ++face) {
            for (int kind : {2, 1, 0}) {
                FaceGroups const& groups = _scene.groups[kind];
                if (groups.faceGroup.empty() || groups.faceGroup[face] == current[kind]) continue;
                current[kind] = groups.faceGroup[face];
                fmt::format_to(std::back_inserter(_text), "{} {}\n", kKeywords[kind],
                               current[kind] < 0 ? "" : groups.names[current[kind]]);
            }
            _text.push_back('f');
            for (int i = 0; i < cage.faceSizes[face]; ++i, ++corner) {
                fmt::format_to(std::back_inserter(_text), " {}", cage.faceVertices[corner] + 1);
                if (_scene.HasUVs(face)) {
                    fmt::format_to(std::back_inserter(_text), "/{}",
                                   GetUVNumber(cage.fvarChannels[0].valueIndices[corner]));
                }
                if (!_scene.normals.empty()) {
                    fmt::format_to(std::back_inserter(_text), "{}/{}",
                                   _scene.HasUVs(face) ? "" : "/", cage.faceVertices[corner] + 1);
                }
            }
            _text.push_back('\n');
        }
    }

    void AppendTags() {
        auto const& cage = _scene.cage;
        auto const line = [&]<class... T>(fmt::format_string<T...> format, T&&... arguments) {
            fmt::format_to(std::back_inserter(_text), format, std::forward<T>(arguments)...);
        };
        for (size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
            line("t crease 2/1/0 {} {} {}\n", cage.creaseVertexPairs[2 * i],
                 cage.creaseVertexPairs[2 * i + 1], cage.creaseSharpness[i]);
        }
        for (size_t i = 0; i < cage.cornerSharpness.size(); ++i) {
            line("t corner 1/1/0 {} {}\n", cage.cornerVertices[i], cage.cornerSharpness[i]);
        }
        for (Index hole : cage.holes) line("t hole 1/0/0 {}\n", hole);
        constexpr int kBoundaryTag[] = {0, 2, 1};  // none, edge only, edge and corner
        line("t interpolateboundary 1/0/0 {}\n",
             kBoundaryTag[cage.options.GetVtxBoundaryInterpolation()]);
        if (_scene.HasUVs()) {
            line("t facevaryinginterpolateboundary 1/0/0 {}\n",
                 static_cast<int>(cage.options.GetFVarLinearInterpolation()));
        }
        if (cage.options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN)
            line("t creasemethod 0/0/1 chaikin\n");
        if (cage.options.GetTriangleSubdivision() == Sdc::Options::TRI_SUB_SMOOTH)
            line("t smoothtriangles 0/0/1 smooth\n");
    }

    Scene const& _scene;
    Precision _precision;
    std::vector<Index> _uvNumbers;  // from 1, per value; empty where the values keep their order
    fmt::memory_buffer _text;
};

class PlyBytes {
public:
    PlyBytes(Scene const& scene, Precision precision)
        : _scene(scene), _isDouble(precision == Precision::Double) {}

    std::string Make() {
        AppendHeader();
        far_ext::Points const points(_scene.positions);
        for (Index vertex = 0; vertex < _scene.cage.numVertices; ++vertex) {
            for (double coordinate : points[vertex]) AppendReal(coordinate);
            for (Primvar const& primvar : _scene.primvars) {
                size_t const n = primvar.numChannels;
                for (size_t c = 0; c < n; ++c) AppendRaw(primvar.values[vertex * n + c]);
            }
        }
        size_t corner = 0;
        for (Index face = 0; face < _scene.cage.GetNumFaces(); ++face) {
            int const size = _scene.cage.faceSizes[face];
            AppendRaw(static_cast<int32_t>(size));
            for (int i = 0; i < size; ++i)
                AppendRaw(static_cast<int32_t>(_scene.cage.faceVertices[corner + i]));
            if (_scene.HasUVs()) {
                int const numWithUVs = _scene.HasUVs(face) ? size : 0;
                AppendRaw(static_cast<int32_t>(2 * numWithUVs));
                for (int i = 0; i < numWithUVs; ++i) {
                    Index const value = _scene.cage.fvarChannels[0].valueIndices[corner + i];
                    AppendReal(_scene.uvs[2 * static_cast<size_t>(value)]);
                    AppendReal(_scene.uvs[2 * static_cast<size_t>(value) + 1]);
                }
            }
            corner += size;
        }
        return std::move(_bytes);
    }

private:
    static std::string NameChannel(Primvar const& primvar, int channel) {
        static char const* const kColours[] = {"red", "green", "blue", "alpha"};
        if (primvar.numChannels == 1) return primvar.name;
        return primvar.numChannels <= 4 ? kColours[channel]
                                        : fmt::format("{}_{}", primvar.name, channel);
    }

    void AppendHeader() {
        char const* const real = _isDouble ? "double" : "float";
        auto const line = [&]<class... T>(fmt::format_string<T...> format, T&&... arguments) {
            fmt::format_to(std::back_inserter(_bytes), format, std::forward<T>(arguments)...);
        };
        line("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", _scene.cage.numVertices);
        for (char const* axis : {"x", "y", "z"}) line("property {} {}\n", real, axis);
        for (Primvar const& primvar : _scene.primvars) {
            for (int c = 0; c < primvar.numChannels; ++c)
                line("property float {}\n", NameChannel(primvar, c));
        }
        line("element face {}\nproperty list int int vertex_indices\n", _scene.cage.GetNumFaces());
        if (_scene.HasUVs()) line("property list int {} texcoord\n", real);
        line("end_header\n");
    }

    template <class T>
    void AppendRaw(T value) {
        static_assert(std::endian::native == std::endian::little);
        _bytes.append(reinterpret_cast<char const*>(&value), sizeof value);
    }
    void AppendReal(double value) {
        _isDouble ? AppendRaw(value) : AppendRaw(static_cast<float>(value));
    }

    Scene const& _scene;
    bool _isDouble;
    std::string _bytes;
};

/// \param length  values per element
void RequireFloats(char const* what, std::vector<double> const& values, size_t length) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    auto const bad = std::ranges::find_if(values, [](double v) { return std::abs(v) > kLargest; });
    if (bad == values.end()) return;
    throw Error(ErrorCode::BadMesh,
                fmt::format("{} {} is {:g}, and a float at most {:g}; use `precision` double", what,
                            static_cast<size_t>(bad - values.begin()) / length, *bad, kLargest));
}

/// Refuses what no file can say.
void CheckWritable(Scene const& scene, Precision precision) {
    CheckScene(scene);
    if (precision == Precision::Double) return;
    RequireFloats("position of vertex", scene.positions, 3);
    RequireFloats("texture coordinate", scene.uvs, 2);
}

}  // namespace

void RequireMeshEnding(std::string const& path) {
    std::string const ending = GetEnding(path);
    if (ending == ".obj" || ending == ".ply") return;
    throw Error(ErrorCode::BadOption,
                fmt::format("`path` '{}': a mesh is written as .obj or .ply", path));
}

MeshBytes FormatMesh(std::string const& path, Scene const& scene, Precision precision) {
    RequireMeshEnding(path);
    NamingMesh(fmt::format("'{}'", path), [&] { CheckWritable(scene, precision); });
    MeshBytes file;
    if (GetEnding(path) == ".obj") {
        if (scene.primvars.size() > (FindObjColours(scene) ? 1 : 0))
            file.leftOut.push_back(path + ": OBJ holds no primvars but colours; they are left out");
        file.bytes = ObjText(scene, precision).Make();
        return file;
    }
    auto const& cage = scene.cage;
    if (!cage.creaseSharpness.empty() || !cage.cornerSharpness.empty() || !cage.holes.empty())
        file.leftOut.push_back(path +
                               ": PLY holds no creases, corners or holes; they are left out");
    file.bytes = PlyBytes(scene, precision).Make();
    return file;
}

std::vector<std::string> WriteMesh(std::string const& path, Scene const& scene,
                                   Precision precision) {
    auto [bytes, leftOut] = FormatMesh(path, scene, precision);
    WriteFileAtomically(path, bytes);
    return leftOut;
}

std::vector<std::string> MeshSequence::Add(std::string const& path, Scene const& scene,
                                           Precision precision) {
    auto [bytes, leftOut] = FormatMesh(path, scene, precision);
    Add(path, bytes);
    return leftOut;
}

void MeshSequence::Add(std::string const& path, std::string const& bytes) {
    AtomicFile& file = Open(path);
    file.Write(bytes);
    file.Finish();
}

AtomicFile& MeshSequence::Open(std::string const& path) {
    return *_files.emplace_back(std::make_unique<AtomicFile>(path));
}

}  // namespace limn::engine
