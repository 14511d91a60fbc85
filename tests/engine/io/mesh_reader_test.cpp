// SPDX-License-Identifier: Apache-2.0
#include "engine/io/mesh_reader.h"

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"
#include "support/readers.h"

namespace limn {
namespace {

TEST(MeshReader, ChoosesByEndingAndThenByFirstBytes) {
    test::TemporaryFolder const folder;
    for (std::string const name : {"a.off", "a.OFF", "a.mesh"}) {
        EXPECT_EQ(engine::ReadMesh(folder.Write(name, test::kOffQuad)).cage.numVertices, 4) << name;
    }
    for (std::string const name : {"a.obj", "a.OBJ", "a.PLY"}) {  // which contradict
        EXPECT_THROW(engine::ReadMesh(folder.Write(name, test::kOffQuad)), Error) << name;
    }
}

TEST(MeshReader, KnowsNameAndChecksumOfTheFile) {
    test::TemporaryFolder const folder;
    engine::Scene const scene = engine::ReadMesh(folder.Write("some.quad.off", test::kOffQuad));
    EXPECT_EQ(scene.name, "some.quad");
    // sha256sum of kOffQuad
    EXPECT_EQ(scene.sha256, "b6a8fcc3bd3d5d5ca0616db0b1004cf66e4735145d0ffd738cf1a93b7c767104");
}

TEST(MeshReader, MissingFileAndFolderAreIoErrors) {
    test::TemporaryFolder const folder;
    for (std::string const& path : {folder / "none.obj", folder.GetPath()}) {
        auto const error = test::CatchError([&] { engine::ReadMesh(path); });
        ASSERT_TRUE(error) << path;
        EXPECT_EQ(error->GetCode(), ErrorCode::Io);
        EXPECT_NE(std::string(error->what()).find(path), std::string::npos) << error->what();
    }
}

TEST(MeshReader, EmptyFileIsRefusedByName) {
    test::TemporaryFolder const folder;
    std::string const path = folder.Write("empty.ply", "");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadMesh(path); }), path + ": the file is empty");
}

}  // namespace
}  // namespace limn
