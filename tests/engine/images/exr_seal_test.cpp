// SPDX-License-Identifier: Apache-2.0
#include "engine/images/exr_seal.h"

#include <gtest/gtest.h>

#include "engine/images/exr_writer.h"
#include "engine/scene/sha256.h"
#include "support/files.h"

namespace limn {
namespace {

using engine::CheckSeal;

class ExrSeal : public testing::Test {
protected:
    test::TemporaryFolder folder;
    std::string const path = folder / "a.exr";

    void SetUp() override { Write(engine::ExrCompression::Zip); }

    void Write(engine::ExrCompression compression) const {
        engine::ExrSpec spec;
        spec.width = spec.height = 64;
        spec.compression = compression;
        spec.channels = {"Y"};
        engine::ExrWriter writer(path, spec);
        std::vector<float> const plane(64 * 64, 0.5f);
        float const* const tile = plane.data();
        writer.Write(writer.Pack(0, 0, 0, &tile, 64));
        writer.Seal({-1.5f, 4.0f})->Commit();
    }
};

TEST_F(ExrSeal, TellsTheRangeThatWasWritten) {
    for (auto const compression : {engine::ExrCompression::Zip, engine::ExrCompression::Piz}) {
        Write(compression);
        EXPECT_EQ(CheckSeal(path), (engine::ValueRange{-1.5f, 4.0f}));
    }
}

// So that other programs can check it, too.
TEST_F(ExrSeal, IsTheHashOfTheFileWithZerosInItsPlace) {
    std::string bytes = test::ReadText(path);
    auto const attributes = engine::ReadExrAttributes(path, engine::kSealAttribute);
    ASSERT_EQ(attributes.size(), 1u);
    std::string const seal = attributes[0].second;
    bytes.replace(bytes.find(seal), seal.size(), engine::kBlankSeal);
    EXPECT_EQ(engine::Sha256(bytes), seal);
}

TEST_F(ExrSeal, BreaksWithAnyByte) {
    std::string const whole = test::ReadText(path);
    for (size_t at = 0; at < whole.size(); at += at < 700 ? 3 : 37) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x10);
        test::WriteText(path, changed);
        EXPECT_FALSE(CheckSeal(path)) << at;
    }
}

TEST_F(ExrSeal, BreaksWithAByteMoreOrLess) {
    std::string const whole = test::ReadText(path);
    for (size_t size : {whole.size() - 1, whole.size() / 2, size_t{300}, size_t{9}, size_t{0}}) {
        test::WriteText(path, whole.substr(0, size));
        EXPECT_FALSE(CheckSeal(path)) << size;
    }
    test::WriteText(path, whole + "x");
    EXPECT_FALSE(CheckSeal(path));
}

TEST_F(ExrSeal, IsNoneWhereThereIsNoImage) {
    EXPECT_FALSE(CheckSeal(folder / "none"));
    EXPECT_FALSE(CheckSeal(folder.Write("text", "no image, but longer than a header's beginning")));
}

}  // namespace
}  // namespace limn
