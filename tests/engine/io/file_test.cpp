// SPDX-License-Identifier: Apache-2.0
#include "engine/io/file.h"

#include <gtest/gtest.h>

#include "engine/scene/sha256.h"
#include "support/errors.h"
#include "support/files.h"

namespace limn {
namespace {

TEST(Sha256OfFile, IsThatOfItsBytes) {
    test::TemporaryFolder const folder;
    std::string const bytes(3'000'000, 'x');  // more than one block
    EXPECT_EQ(engine::Sha256OfFile(folder.Write("a", bytes)), engine::Sha256(bytes));
    EXPECT_EQ(test::CodeOf([&] { engine::Sha256OfFile(folder / "none"); }), ErrorCode::Io);
}

TEST(Sha256OfFile, EndsWhereItsCheckThrows) {
    struct Stop {};
    test::TemporaryFolder const folder;
    std::string const path = folder.Write("a", "x");
    EXPECT_THROW(engine::Sha256OfFile(path, [] { throw Stop{}; }), Stop);
}

}  // namespace
}  // namespace limn
