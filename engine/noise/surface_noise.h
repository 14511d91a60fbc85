// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/stencils/table_evaluator.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/refined_faces.h"
#include "far_ext/enum_words.h"

namespace limn::engine {

/// Where in space a vertex's noise is taken from.
enum class NoiseAt {
    Limit,  ///< its limit point, which lies on the surface
    Vertex  ///< the vertex of the refined mesh: the paper's
};

inline constexpr auto kNoiseAtWords =
    MakeEnumWords<NoiseAt>("at", {{NoiseAt::Limit, "limit"}, {NoiseAt::Vertex, "vertex"}});

struct NoiseOptions {
    int octaves = 4;  ///< 1 to 10: one refinement level each
    /// Of the first octave, cells per unit length; none: half a cell per mean edge.
    std::optional<double> frequency{};
    double gain = 0.5;  ///< amplitude from octave to octave
    uint64_t seed = 0;
    NoiseAt at = NoiseAt::Limit;
    /// Applies the rules of refinement as tables in float; null: in double.
    eval::TableEvaluator* evaluator = nullptr;
};

/// Noise on a limit surface, without texture coordinates: for each level i of refinement, noise of
/// frequency 2^i and amplitude gain^i at its vertices, interpolated by a fitted scalar subdivision
/// surface; the sum of all of them, at any place of the surface.
///
/// Each octave's control values P solve A P = N on their level, so that the limit passes through
/// the noise N at the limit of every vertex; refined by the surface's own rules they add up on the
/// finest level. Where A has no inverse, which only happens on level 0, N is first freed of the
/// alternating part that no P can reach.
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

    /// Levels with components on which A has no inverse; there is a warning of each.
    std::vector<int> const& GetSingularLevels() const { return _singularLevels; }

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
    std::vector<int> _singularLevels;
};

/// The same noise at the limits of all vertices of a refinement level, in OpenSubdiv's order.
struct VertexNoise {
    std::vector<double> values;
    double low = 0.0, high = 0.0;     ///< as SurfaceNoise's
    std::vector<int> singularLevels;  ///< as SurfaceNoise's
};

/// \param level   0 to 10
/// \throws Error  as SurfaceNoise; TooLarge where the level would pass 2^31 indices
/// \throws Stopped
VertexNoise FindVertexNoise(Model const& model, NoiseOptions const& options, int level, Job& job);

}  // namespace limn::engine
