// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/refined_faces.h"

namespace limn::engine {

struct NoiseOptions {
    int octaves = 4;  ///< 1 to 10: one refinement level each
    /// Of the first octave, cells per unit length; none: half a cell per mean edge.
    std::optional<double> frequency{};
    double gain = 0.5;  ///< amplitude from octave to octave
    uint64_t seed = 0;
};

/// Noise on a limit surface, without texture coordinates: for each level i of refinement, noise of
/// frequency 2^i and amplitude gain^i at its vertices, interpolated by a fitted scalar subdivision
/// surface; the sum of all of them, at any place of the surface.
///
/// Each octave's control values P solve A P = N on their level, so that the limit passes through
/// the noise N at the limit of every vertex; refined by the surface's own rules they add up on the
/// finest level.
///
/// Source   [LaiCheng11] Sec. 5; [Limit 8]
class SurfaceNoise {
public:
    /// \throws Error  BadOption; TooLarge where the finest level would pass 2^31 indices
    /// \throws Stopped
    SurfaceNoise(Model const& model, NoiseOptions const& options, Job& job);

    /// Least and largest value over the limits of all vertices of the finest level.
    double GetLow() const { return _low; }
    double GetHigh() const { return _high; }

    /// Evaluates places; one per thread.
    class Sampler {
    public:
        explicit Sampler(SurfaceNoise const& noise);

        /// \param face    of the model, with a limit; \param domain as in eval::LimitSurface
        /// \param values  one per place
        void Evaluate(Index face, int domain, std::span<double const> s, std::span<double const> t,
                      std::span<double> values);

    private:
        SurfaceNoise const& _noise;
        eval::FaceTree _tree;
        std::vector<eval::RefinedFaces::Sample> _places;
    };

private:
    far_ext::ControlMesh _cage;   // the finest level
    std::vector<double> _values;  // of its vertices
    std::unique_ptr<Far::TopologyRefiner> _refiner;
    std::unique_ptr<eval::LimitSurface> _surface;
    std::unique_ptr<eval::RefinedFaces> _faces;
    double _low = 0.0, _high = 0.0;
};

}  // namespace limn::engine
