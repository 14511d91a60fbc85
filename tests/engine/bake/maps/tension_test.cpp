// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "far_ext/error.h"
#include "support/meshes.h"

namespace limn {
namespace {

using Eigen::Vector3d;

/// The mesh with each vertex taken through a linear map.
engine::Model Transform(engine::Model const& model, Eigen::Matrix3d const& map) {
    std::vector<double> positions = model.GetPositions();
    for (size_t i = 0; i < positions.size(); i += 3) {
        Eigen::Map<Vector3d> point(&positions[i]);
        point = map * Vector3d(point);
    }
    return model.WithPoints(std::move(positions));
}

/// A flat sheet of n x n quads with the texture coordinates of its place.
engine::Scene MakeSheet(int n) {
    std::vector<double> positions, uvs;
    std::vector<std::vector<Index>> faces;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            double const x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
            positions.insert(positions.end(), {x, y, 0.0});
            uvs.insert(uvs.end(), {x, y});
            Index const at = j * (n + 1) + i;
            if (i < n && j < n) faces.push_back({at, at + 1, at + n + 2, at + n + 1});
        }
    }
    engine::Scene scene = test::MakeScene(std::move(positions), faces);
    scene.cage.fvarChannels.push_back({scene.cage.numVertices, scene.cage.faceVertices});
    scene.uvs = std::move(uvs);
    return scene;
}

struct Texel {
    double s1, s2;
    Vector3d direction;
};

/// The covered texels of tension's map, row by row.
std::vector<Texel> BakeTension(engine::Model const& posed, engine::Model const& rest,
                               int samplesPerSide = 1) {
    engine::BakeOptions options;
    options.maps = {"tension"};
    options.rest = rest;
    options.width = options.height = 48;
    options.samplesPerSide = samplesPerSide;
    engine::Job job;
    auto const image = engine::BakeToMemory(posed, options, job).images.at(0);
    EXPECT_EQ(image.channels, (std::vector<std::string>{"s1", "s2", "R", "G", "B"}));
    std::vector<Texel> texels;
    for (size_t i = 0; i < image.coverage.size(); ++i) {
        if (image.coverage[i] == 0.0f) continue;
        float const* const at = &image.texels[5 * i];
        texels.push_back({at[0], at[1], Vector3d(at[2], at[3], at[4])});
    }
    EXPECT_GT(texels.size(), 300u);
    return texels;
}

void ExpectLine(Vector3d const& found, Vector3d const& expected) {
    EXPECT_NEAR(std::abs(found.dot(expected)), 1.0, 1e-5) << found.transpose();
}

/// A rotation, so that nothing is tested along an axis alone.
Eigen::Matrix3d Turn() {
    return (Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()) *
            Eigen::AngleAxisd(-1.1, Vector3d::UnitX()))
        .toRotationMatrix();
}

TEST(Tension, IsOneWhereNothingButTheViewHasChanged) {
    auto const rest = engine::Model::Build(MakeSheet(4));
    for (Texel const& texel : BakeTension(Transform(rest, Turn()), rest)) {
        EXPECT_NEAR(texel.s1, 1.0, 1e-6);
        EXPECT_NEAR(texel.s2, 1.0, 1e-6);
    }
}

TEST(Tension, OfAStretchIsItsFactors) {
    auto const rest = engine::Model::Build(MakeSheet(4));
    Eigen::Matrix3d const stretch = Vector3d(0.5, 2.0, 1.0).asDiagonal();
    for (int samplesPerSide : {1, 2}) {
        for (Texel const& texel :
             BakeTension(Transform(rest, Turn() * stretch), rest, samplesPerSide)) {
            EXPECT_NEAR(texel.s1, 2.0, 1e-5);
            EXPECT_NEAR(texel.s2, 0.5, 1e-5);
            ExpectLine(texel.direction, Turn() * Vector3d::UnitY());
        }
    }
}

// x' = x + k y: s1 s2 = 1 and s1 - s2 = k, so that s1 = (k + sqrt(k^2 + 4)) / 2. F F^T =
// [[1 + k^2, k], [k, 1]] has its first axis at (s1, 1) / |(s1, 1)|.
TEST(Tension, OfAShearHasTheClosedForm) {
    auto const rest = engine::Model::Build(MakeSheet(4));
    double const k = 0.75, s1 = 0.5 * (k + std::sqrt(k * k + 4.0));
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = k;
    for (Texel const& texel : BakeTension(Transform(rest, shear), rest)) {
        EXPECT_NEAR(texel.s1, s1, 1e-5);
        EXPECT_NEAR(texel.s2, 1.0 / s1, 1e-5);
        ExpectLine(texel.direction, Vector3d(s1, 1.0, 0.0).normalized());
    }
}

// Subdivision commutes with linear maps: on any surface F is the map, restricted to the tangent
// plane. The product of both is the ratio of areas, |A^-T n| det A; and the direction lies in the
// surface.
TEST(Tension, OfALinearMapIsTheMapOnTheTangentPlane) {
    Eigen::Matrix3d map;
    map << 1.2, 0.3, 0.0, -0.2, 0.8, 0.1, 0.4, 0.0, 1.5;
    for (auto const& rest : {engine::Model::Build(test::MakeTorus(12, 8)),
                             engine::Model::Build(test::LoadData("../../scenes/spot/spot.obj"))}) {
        auto const posed = Transform(rest, map);
        engine::BakeOptions options;
        options.width = options.height = 48;
        options.maps = {"normal"};
        engine::Job job;
        auto const normals = engine::BakeToMemory(rest, options, job).images.at(0);
        auto const texels = BakeTension(posed, rest);
        size_t next = 0;
        for (size_t i = 0; i < normals.coverage.size(); ++i) {
            if (normals.coverage[i] == 0.0f) continue;
            Vector3d const normal(normals.texels[3 * i], normals.texels[3 * i + 1],
                                  normals.texels[3 * i + 2]);
            Eigen::Matrix<double, 3, 2> frame;
            frame.col(0) = normal.unitOrthogonal();
            frame.col(1) = normal.cross(frame.col(0));
            Eigen::JacobiSVD<Eigen::Matrix<double, 3, 2>> const svd(map * frame,
                                                                    Eigen::ComputeFullU);
            ASSERT_LT(next, texels.size());
            Texel const& texel = texels[next++];
            ASSERT_NEAR(texel.s1, svd.singularValues()[0], 2e-5);
            ASSERT_NEAR(texel.s2, svd.singularValues()[1], 2e-5);
            if (svd.singularValues()[0] < 1.01 * svd.singularValues()[1]) continue;  // any line
            ASSERT_NEAR(std::abs(texel.direction.dot(svd.matrixU().col(0))), 1.0, 1e-4);
        }
        EXPECT_EQ(next, texels.size());
    }
}

// A face that is folded to a line at rest has no tangent plane there: numbers all the same.
TEST(Tension, IsANumberWhereTheRestIsDegenerate) {
    engine::Scene flat = MakeSheet(3);
    for (size_t i = 0; i < flat.positions.size(); i += 3) {
        if (flat.positions[i] < 0.5) flat.positions[i] = 0.0;
    }
    auto const rest = engine::Model::Build(std::move(flat));
    for (Texel const& texel : BakeTension(engine::Model::Build(MakeSheet(3)), rest)) {
        EXPECT_TRUE(std::isfinite(texel.s1) && std::isfinite(texel.s2));
        EXPECT_GE(texel.s1, texel.s2);
    }
    for (Texel const& texel : BakeTension(rest, engine::Model::Build(MakeSheet(3)))) {
        EXPECT_TRUE(std::isfinite(texel.s1) && std::isfinite(texel.s2));
        EXPECT_GE(texel.s2, 0.0);
    }
}

TEST(Tension, NeedsARestMeshOfTheSameFaces) {
    auto const sheet = engine::Model::Build(MakeSheet(4));
    engine::BakeOptions options;
    options.maps = {"tension"};
    engine::Job job;
    try {
        engine::BakeToMemory(sheet, options, job);
        FAIL() << "no error";
    } catch (Error const& error) {
        EXPECT_EQ(error.GetCode(), ErrorCode::BadOption);
    }
    options.rest = engine::Model::Build(MakeSheet(3));
    try {
        engine::BakeToMemory(sheet, options, job);
        FAIL() << "no error";
    } catch (Error const& error) {
        EXPECT_EQ(error.GetCode(), ErrorCode::BadMesh);
    }
}

}  // namespace
}  // namespace limn
