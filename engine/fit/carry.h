// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/fit/limit_application.h"
#include "far_ext/enum_words.h"

namespace limn::engine {

/// How vectors at the vertices of one mesh become those of another of the same faces.
enum class Carry {
    Object,  ///< as they are
    Local  ///< turned with the surface: by eval::LocalRotations between the meshes smoothed by A^8
};

inline constexpr auto kCarryWords =
    MakeEnumWords<Carry>("carry", {{Carry::Object, "object"}, {Carry::Local, "local"}});

/// Carries a vector per vertex, in place.
///
/// \param A      the limit matrix by which both meshes are smoothed
/// \param from   the positions of the mesh that the vectors are of; \param to  of the other
/// \return       the largest angle by which one has been turned, in degrees
/// \throws Stopped
/// Source   [Limit 7]
double CarryVectors(Carry carry, eval::LimitApplication const& A, Far::TopologyLevel const& level,
                    std::span<double const> from, std::span<double const> to,
                    std::span<double> vectors, Job& job);

}  // namespace limn::engine
