// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/fit/carry.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

struct WeightedMesh {
    Model mesh;
    double weight = 1.0;
};

/// What takes one mesh to another.
struct WeightedOffset {
    Model from, to;
    double weight = 1.0;
};

struct CombineOptions {
    double scale = 1.0;
    std::vector<WeightedMesh> added{};
    std::vector<WeightedOffset> offsets{};
    Carry carry = Carry::Local;  ///< of offsets, from where they start to the mesh

    /// \throws Error  BadOption
    void Check() const;
};

/// A sum of meshes of the same faces.
struct Combination {
    Scene mesh;  ///< tags, UVs, groups and primvars of the first; scalars that all added meshes
                 ///< have are added, too
    double maxOffset = 0.0, rmsOffset = 0.0;  ///< of its vertices, from where they were
    double largestTurnDegrees = 0.0;          ///< of an offset
};

/// scale M + sum of weight O + sum of weight R (B - A), with R as Carry says.
///
/// \throws Error  BadMesh: other faces than the mesh's (the first difference is named).  BadOption:
///                a weight that is no number.  TooLarge: a sum beyond the range of its numbers
/// \throws Stopped
/// Source  [Limit 7]
Combination Combine(Model const& model, CombineOptions const& options, Job& job);

/// The way from a mesh to other positions of its vertices as the scalars NAMEx, NAMEy and NAMEz.
///
/// \throws Error  BadOption: positions of another number of vertices
std::vector<Primvar> MakeOffsetPrimvars(std::string const& name, Model const& model,
                                        std::vector<double> const& positions);

}  // namespace limn::engine
