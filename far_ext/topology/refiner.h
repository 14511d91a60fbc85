// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/topology/control_mesh.h"

namespace limn::far_ext {

/// OpenSubdiv reports errors through a global callback and returns empty or zero results. A guard
/// collects what OpenSubdiv reports on this thread while it lives; ThrowIfReported turns the first
/// error into an exception, after OpenSubdiv has returned and never through its frames. Guards
/// nest; each hears the innermost calls only.
class FarReportGuard {
public:
    FarReportGuard();
    ~FarReportGuard();
    FarReportGuard(FarReportGuard const&) = delete;
    FarReportGuard& operator=(FarReportGuard const&) = delete;

    /// \throws Error  BadMesh, with OpenSubdiv's words on one line after `doing`
    void ThrowIfReported(char const* doing) const;

    std::vector<std::string> const& GetWarnings() const { return _warnings; }

private:
    friend struct FarReportSink;
    std::vector<std::string> _errors, _warnings;
    FarReportGuard* _outer;
};

/// Builds OpenSubdiv's unrefined topology of a cage.
///
/// \param mesh      a validated cage
/// \param warnings  receives what OpenSubdiv remarked, one line each; may be null
/// \throws Error    BadMesh where OpenSubdiv refuses the topology
std::unique_ptr<Far::TopologyRefiner> CreateRefiner(ControlMesh const& mesh,
                                                    std::vector<std::string>* warnings = nullptr);

}  // namespace limn::far_ext
