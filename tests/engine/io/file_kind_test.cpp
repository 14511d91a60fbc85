// SPDX-License-Identifier: Apache-2.0
#include "engine/io/file_kind.h"

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "support/errors.h"
#include "support/files.h"

namespace limn {
namespace {

struct ForeignFile {
    std::string name, bytes, kind;
};

void PrintTo(ForeignFile const& file, std::ostream* out) {
    *out << file.name;
}

/// Triangles without any meaning.
std::string MakeBinaryStl(int count) {
    std::string bytes(84 + 50 * static_cast<size_t>(count), '\x7f');
    bytes[80] = static_cast<char>(count);
    bytes[81] = bytes[82] = bytes[83] = '\0';
    return bytes;
}

class ForeignFiles : public testing::TestWithParam<ForeignFile> {};

TEST_P(ForeignFiles, AreRefusedByNameWhateverTheyAreCalled) {
    test::TemporaryFolder const folder;
    for (std::string const name : {"a.obj", "a.ply", "a.off", "a.mesh"}) {
        std::string const path = folder.Write(name, GetParam().bytes);
        EXPECT_EQ(test::RefusalOf([&] { engine::ReadMesh(path); }),
                  path + ": looks like " + GetParam().kind + ": OBJ, PLY or OFF is needed");
    }
}

INSTANTIATE_TEST_SUITE_P(
    Of, ForeignFiles,
    testing::Values(
        ForeignFile{"Usda", "#usda 1.0\n(\n)\n", "USD"},
        ForeignFile{"UsdaBehindMark", "\xef\xbb\xbf#usda 1.0\n(\n)\n", "USD"},
        ForeignFile{"Usdc", std::string("PXR-USDC\0\x08", 10), "USD (binary)"},
        ForeignFile{"Usdz", std::string("PK\x03\x04\x0a\0", 6), "ZIP (USDZ, 3MF, a spreadsheet?)"},
        ForeignFile{"Glb", std::string("glTF\x02\0\0\0", 8), "glTF (binary)"},
        ForeignFile{"Gltf", " {\n \"asset\": {\"version\": \"2.0\"}}", "glTF"},
        ForeignFile{"Json", "{\"a\": 1}", "JSON"},
        ForeignFile{"Fbx", std::string("Kaydara FBX Binary  \0\x1a", 22), "FBX"},
        ForeignFile{"FbxText", "; FBX 7.4.0 project file\n", "FBX (text)"},
        ForeignFile{"Alembic", "Ogawa\xff", "Alembic"},
        ForeignFile{"AlembicOfHdf5", "\x89HDF\r\n\x1a\n", "HDF5 (Alembic?)"},
        ForeignFile{"Stl", MakeBinaryStl(2), "STL"},
        ForeignFile{"StlText", "solid part\nfacet normal 0 0 1\n", "STL (text)"},
        ForeignFile{"Exr", "\x76\x2f\x31\x01\x02", "an image (OpenEXR)"},
        ForeignFile{"Png", "\x89PNG\r\n\x1a\n", "an image (PNG)"},
        ForeignFile{"Jpeg", "\xff\xd8\xff\xe0", "an image (JPEG)"},
        ForeignFile{"Gzip", "\x1f\x8b\x08", "gzip; unpack it first"},
        ForeignFile{"Zstd", "\x28\xb5\x2f\xfd", "zstd; unpack it first"},
        ForeignFile{"Blender", "BLENDER-v300", "a scene of Blender"},
        ForeignFile{"MayaAscii", "//Maya ASCII 2024 scene\n", "a scene of Maya"},
        ForeignFile{"Collada", "\xef\xbb\xbf<?xml version=\"1.0\"?>\n<COLLADA>", "COLLADA"},
        ForeignFile{"WebPage", "<!DOCTYPE html>\n<html>", "a web page"},
        ForeignFile{"LfsPointer", "version https://git-lfs.github.com/spec/v1\n",
                    "a Git LFS pointer; fetch the file itself"}),
    [](auto const& file) { return file.param.name; });

TEST(FileKind, WhatLimnReadsIsNotForeign) {
    for (std::string const text :
         {"v 0 0 0\n", "# solid facts\nv 0 0 0\n", "ply\nformat ascii 1.0\n", "OFF\n1 1 0\n",
          "face,s,t\n", "mtllib glTF.mtl\n", "", "s off\n"}) {
        EXPECT_EQ(engine::RecogniseForeignFile(text), "") << text;
    }
}

TEST(FileKind, AMeshWhoseNameContradictsItsBytesIsToBeRenamed) {
    test::TemporaryFolder const folder;
    std::string const ply = folder.Write("a.obj", "ply\nformat ascii 1.0\n"),
                      off = folder.Write("b.obj", "STCNOFF\n"),
                      offAsPly = folder.Write("c.ply", "OFF\n");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadMesh(ply); }),
              ply + ": looks like PLY: rename it to .ply");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadMesh(off); }),
              off + ": looks like OFF: rename it to .off");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadMesh(offAsPly); }),
              offAsPly + ": looks like OFF: rename it to .off");
}

}  // namespace
}  // namespace limn
