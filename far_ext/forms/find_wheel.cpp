// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/find_wheel.h"

#include <vector>

#include <opensubdiv/sdc/crease.h>

namespace limn::far_ext {

namespace {

using Rule = Sdc::Crease::Rule;

bool IsSmooth(Rule rule) {
    return rule == Sdc::Crease::RULE_SMOOTH || rule == Sdc::Crease::RULE_DART;
}

}  // namespace

double FindFaceShare(Far::TopologyRefiner const& refiner, Far::TopologyLevel const& level,
                     Far::TopologyLevel const* next, Index edge) {
    double const smooth = refiner.GetSchemeType() == Sdc::SCHEME_LOOP ? 0.125 : 0.25;
    float const sharpness = level.GetEdgeSharpness(edge);
    if (sharpness <= 0.0f) return smooth;
    if (!next || next->GetVertexRule(level.GetEdgeChildVertex(edge)) == Sdc::Crease::RULE_CREASE)
        return 0.0;
    return smooth * static_cast<double>(1.0f - sharpness);
}

Wheel FindWheel(Far::TopologyRefiner const& refiner, Far::TopologyLevel const& level,
                Far::TopologyLevel const* next, Index vertex) {
    Sdc::SchemeType const scheme = refiner.GetSchemeType();
    Sdc::Crease const creasing(refiner.GetSchemeOptions());
    auto const faces = level.GetVertexFaces(vertex);
    auto const edges = level.GetVertexEdges(vertex);
    int const numSpokes = edges.size(), k = faces.size();
    Wheel wheel;
    wheel.isInterior = numSpokes == k;
    for (Index face : faces) wheel.sizes.push_back(level.GetFaceVertices(face).size());

    // Sharpness before and after, and the two rules between which OpenSubdiv blends.
    std::vector<float> before, after;
    for (Index edge : edges) {
        wheel.faceShares.push_back(FindFaceShare(refiner, level, next, edge));
        before.push_back(level.GetEdgeSharpness(edge));
        after.push_back(next ? next->GetEdgeSharpness(level.GetEdgeChildEdges(
                                   edge)[level.GetEdgeVertices(edge)[0] == vertex ? 0 : 1])
                             : before.back());
    }
    Rule const parent = level.GetVertexRule(vertex);
    Rule child = parent;
    double t = 1.0;
    if (next) {
        Index const childVertex = level.GetVertexChildVertex(vertex);
        child = next->GetVertexRule(childVertex);
        if (parent != child && !IsSmooth(parent)) {
            t = static_cast<double>(creasing.ComputeFractionalWeightAtVertex(
                level.GetVertexSharpness(vertex), next->GetVertexSharpness(childVertex), numSpokes,
                before.data(), after.data()));
        }
    }

    wheel.edgeWeights.assign(numSpokes, 0.0);
    double const square = static_cast<double>(numSpokes) * numSpokes;
    auto const add = [&](Wheel::Rule& target, Rule rule, std::vector<float> const& sharpness,
                         double share) {
        target.share = share;
        target.isCrease = rule == Sdc::Crease::RULE_CREASE;
        for (float s : sharpness) target.isSharp.push_back(s > 0.0f);
        if (share == 0.0) return;
        if (IsSmooth(rule)) {
            for (double& a : wheel.edgeWeights)
                a += share * (scheme == Sdc::SCHEME_LOOP ? GetLoopWeight(k) : 1.0 / square);
            if (scheme == Sdc::SCHEME_CATMARK) wheel.faceWeight += share / square;
        } else if (target.isCrease) {
            int ends[2];
            creasing.GetSharpEdgePairOfCrease(sharpness.data(), numSpokes, ends);
            for (int end : ends) wheel.edgeWeights[end] += share * 0.125;
        }
    };
    add(wheel.parent, parent, before, t);
    add(wheel.child, child, after, 1.0 - t);
    return wheel;
}

}  // namespace limn::far_ext
