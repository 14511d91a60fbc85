// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "eval/differential/refine_values.h"
#include "far_ext/error.h"
#include "far_ext/rows/sparse_rows.h"
#include "far_ext/topology/refiner.h"
#include "support/files.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn::test {

/// The topology of a scene, refined uniformly.
inline std::unique_ptr<Far::TopologyRefiner> MakeRefiner(engine::Scene const& scene, int levels) {
    auto refiner = far_ext::CreateRefiner(scene.cage);
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    return refiner;
}

/// A mesh of tests/data/differential under its scheme; boundaries as its references have them.
inline engine::Scene LoadDifferential(std::string const& name, Sdc::SchemeType scheme) {
    engine::Scene scene = LoadData("differential/" + name + ".obj");
    scene.cage.scheme = scheme;
    scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return scene;
}

/// The points of a reference of tests/data/differential, which has no faces.
inline std::vector<double> LoadPoints(std::string const& name) {
    std::istringstream text(ReadText(DataPath("differential/" + name + ".obj")));
    std::vector<double> points;
    for (std::string line; std::getline(text, line);) {
        double x, y, z;
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3)
            points.insert(points.end(), {x, y, z});
    }
    return points;
}

inline std::vector<double> Apply(far_ext::SparseRows const& rows,
                                 std::vector<double> const& points) {
    std::vector<double> result(3 * static_cast<size_t>(rows.GetNumRows()));
    rows.Apply(points.data(), result.data(), 3);
    return result;
}

/// Diagonal of the box round points.
inline double BoxDiagonal(std::vector<double> const& points) {
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        double low = points[c], high = points[c];
        for (size_t i = c; i < points.size(); i += 3) {
            low = std::min(low, points[i]);
            high = std::max(high, points[i]);
        }
        sum += (high - low) * (high - low);
    }
    return std::sqrt(sum);
}

/// Largest difference of two arrays, without regard to a translation if so asked.
inline double LargestDifference(std::vector<double> const& a, std::vector<double> const& b,
                                bool isUpToTranslation = false) {
    if (a.size() != b.size()) return 1e300;
    double shift[3] = {0, 0, 0};
    for (size_t i = 0; isUpToTranslation && i < a.size(); ++i)
        shift[i % 3] += 3.0 * (a[i] - b[i]) / static_cast<double>(a.size());
    double worst = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        double const difference = std::abs(a[i] - b[i] - shift[i % 3]);
        if (!(difference <= worst)) worst = difference;  // not a number counts as worst
    }
    return worst;
}

/// Points of the last level, subdivided and moved out to the unit sphere.
inline std::vector<double> SubdivideToSphere(Far::TopologyRefiner const& refiner,
                                             std::vector<double> points) {
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level)
        points = eval::RefineValues<3>(refiner, level, points);
    for (size_t i = 0; i < points.size(); i += 3) {
        double const length = std::hypot(points[i], points[i + 1], points[i + 2]);
        for (size_t c = 0; c < 3; ++c) points[i + c] /= length;
    }
    return points;
}

/// The code of the Error that `act` throws; -1 if it throws none.
template <class Act>
int CodeOf(Act act) {
    try {
        act();
    } catch (Error const& error) {
        return static_cast<int>(error.GetCode());
    }
    return -1;
}

}  // namespace limn::test
