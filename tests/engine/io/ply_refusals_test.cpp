// SPDX-License-Identifier: Apache-2.0
//
// What the reader of PLY refuses: file and line, what is wrong, what would be right.

#include <gtest/gtest.h>

#include "engine/io/ply_reader.h"
#include "support/readers.h"

namespace limn {
namespace {

using test::kPlyTriangle;
using test::Refusal;
using test::RefusalOfPly;

/// kPlyTriangle with something else in place of a part of it.
std::string With(std::string const& part, std::string const& other) {
    std::string text = kPlyTriangle;
    return text.replace(text.find(part), part.size(), other);
}

class PlyRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(PlyRefusal, NamesLineReasonAndRemedy) {
    test::ExpectRefusal(GetParam(), RefusalOfPly(GetParam().text));
}

INSTANTIATE_TEST_SUITE_P(
    Of, PlyRefusal,
    testing::Values(
        Refusal{
            "WrongMagic", With("ply\n", "plyx\n"), "mesh.ply:1: ", {"does not start with 'ply'"}},
        Refusal{"UnknownFormat",
                With("format ascii", "format utf8"),
                "mesh.ply:2: ",
                {"'utf8'", "binary_big_endian"}},
        Refusal{"NoFormat", With("format ascii 1.0\n", ""), "mesh.ply:", {"no 'format' line"}},
        Refusal{"NoEndOfHeader",
                With("end_header", "comment"),
                "mesh.ply:10: ",
                {"'0' has no place in a PLY header"}},
        Refusal{"OnlyAHeader",
                With(kPlyTriangle.substr(kPlyTriangle.find("end_header")), ""),
                "mesh.ply:8: ",
                {"no 'end_header'"}},
        Refusal{"UnknownType", With("float x", "quad x"), "mesh.ply:4: ", {"'quad'"}},
        Refusal{"PropertyBeforeElements",
                With("element vertex 3\n", ""),
                "mesh.ply:3: ",
                {"before the first element"}},
        Refusal{"NoZ", With("property float z\n", ""), "mesh.ply:", {"lacks 'z'", "'x', 'y'"}},
        Refusal{"NoIndices",
                With("vertex_indices", "indices"),
                "mesh.ply:9: ",
                {"vertex_indices", "'indices'"}},
        Refusal{"PointsOnly",
                With("element face 1\nproperty list uchar int vertex_indices\n", ""),
                "mesh.ply:7: ",
                {"no element 'face'", "limn needs polygons"}},
        Refusal{"NoVertices",
                With("element vertex 3", "element point 3"),
                "mesh.ply:9: ",
                {"no element 'vertex'"}},
        Refusal{"EmptyVertices", With("vertex 3", "vertex 0"), "mesh.ply:9: ", {"'vertex'"}},
        Refusal{"ElementTwice",
                With("element face 1", "element vertex 1"),
                "mesh.ply:7: ",
                {"'vertex' comes twice"}},
        Refusal{"PropertyTwice",
                With("float y", "float x"),
                "mesh.ply:5: ",
                {"'x' of element 'vertex' comes twice"}},
        Refusal{"ControlCharacterInAName",
                With("float y\n", "float y\nproperty uchar a\x01b\n"),
                "mesh.ply:6: ",
                {"property name 'a", "holds a control character"}},
        Refusal{"TextureNumberWithAFraction",
                With("vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
                     "vertex_indices\nproperty float texnumber\nend_header\n0 0 0\n1 0 0\n0 1 "
                     "0\n3 0 1 2 0.5"),
                "mesh.ply:14: ",
                {"texnumber is 0.5"}},
        Refusal{"CountThatIsAWord", With("vertex 3", "vertex many"), "mesh.ply:3: ", {"'many'"}},
        Refusal{
            "NegativeCount", With("vertex 3", "vertex -3"), "mesh.ply:3: ", {"count -3", "0 to"}},
        Refusal{
            "CountWithAFraction", With("vertex 3", "vertex 2.5"), "mesh.ply:3: ", {"count 2.5"}},
        Refusal{"CountBeyond32Bits",
                With("vertex 3", "vertex 99999999999"),
                "mesh.ply:3: ",
                {"99999999999"}},
        Refusal{"NoFaces", With("face 1", "face 0"), "mesh.ply:", {"no faces"}},
        Refusal{
            "TextTooShort", With("face 1", "face 2"), "mesh.ply:13: ", {"ends before face 1 of 2"}},
        Refusal{"NotANumber",
                With("1 0 0\n", "1 zero 0\n"),
                "mesh.ply:11: ",
                {"y is 'zero'", "finite number is needed"}},
        Refusal{"VertexWithAnUnnamedNumber",
                With("1 0 0\n", "1 0 0 255\n"),
                "mesh.ply:11: ",
                {"vertex 1 has more values than the header names, '255' the first"}},
        Refusal{"FaceWithAnUnnamedNumber",
                With("3 0 1 2\n", "3 0 1 2 0.5\n"),
                "mesh.ply:13: ",
                {"face 0 has more values", "'0.5'"}},
        Refusal{"Nan", With("1 0 0\n", "1 0 nan\n"), "mesh.ply:11: ", {"z is 'nan'"}},
        Refusal{"Infinity", With("1 0 0\n", "-inf 0 0\n"), "mesh.ply:11: ", {"x is '-inf'"}},
        Refusal{"MissingNumber", With("1 0 0\n", "1 0\n"), "mesh.ply:11: ", {"z is missing"}},
        Refusal{
            "IndexTooLarge", With("3 0 1 2", "3 0 1 3"), "mesh.ply:13: ", {"vertex 3", "0 to 2"}},
        Refusal{
            "NegativeIndex", With("3 0 1 2", "3 0 1 -1"), "mesh.ply:13: ", {"vertex -1", "0 to 2"}},
        Refusal{
            "IndexWithAFraction", With("3 0 1 2", "3 0 1 1.5"), "mesh.ply:13: ", {"vertex 1.5"}},
        Refusal{
            "TwoCorners", With("3 0 1 2", "2 0 1"), "mesh.ply:13: ", {"2 corners", "at least 3"}},
        Refusal{"NegativeListLength", With("3 0 1 2", "-3 0 1 2"), "mesh.ply:13: ", {"length -3"}},
        Refusal{
            "LongListLength", With("3 0 1 2", "900000000 0 1 2"), "mesh.ply:13: ", {"missing"}}),
    [](testing::TestParamInfo<Refusal> const& instance) { return instance.param.name; });

}  // namespace
}  // namespace limn
