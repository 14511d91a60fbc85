// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/sha256.h"

#include <gtest/gtest.h>

namespace limn {
namespace {

// The examples of FIPS 180-2, appendix B.
TEST(Sha256, IsThatOfTheStandard) {
    EXPECT_EQ(engine::Sha256("abc"),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(engine::Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, OfPiecesIsThatOfTheWhole) {
    engine::Sha256Stream stream;
    for (char const* piece : {"a", "", "bc"}) stream.Add(piece);
    EXPECT_EQ(stream.Finish(), engine::Sha256("abc"));
}

}  // namespace
}  // namespace limn
