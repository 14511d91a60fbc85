// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/refiner.h"

#include <algorithm>
#include <mutex>

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include "far_ext/error.h"

namespace limn::far_ext {

namespace {
thread_local FarReportGuard* innermostGuard = nullptr;
}

/// Receives OpenSubdiv's callbacks and hands them to this thread's innermost guard.
struct FarReportSink {
    static std::string OneLine(char const* message) {
        std::string line(message ? message : "");
        std::replace(line.begin(), line.end(), '\n', ' ');
        while (!line.empty() && line.back() == ' ') line.pop_back();
        return line;
    }
    static void OnError(Far::ErrorType, char const* message) {
        if (innermostGuard) innermostGuard->_errors.push_back(OneLine(message));
    }
    static void OnWarning(char const* message) {
        if (innermostGuard) innermostGuard->_warnings.push_back(OneLine(message));
    }
};

FarReportGuard::FarReportGuard() : _outer(innermostGuard) {
    static std::once_flag installed;
    std::call_once(installed, [] {
        Far::SetErrorCallback(&FarReportSink::OnError);
        Far::SetWarningCallback(&FarReportSink::OnWarning);
    });
    innermostGuard = this;
}

FarReportGuard::~FarReportGuard() {
    innermostGuard = _outer;
}

void FarReportGuard::ThrowIfReported(char const* doing) const {
    if (!_errors.empty()) {
        throw Error(ErrorCode::BadMesh, std::string(doing) + ": OpenSubdiv: " + _errors.front());
    }
}

std::unique_ptr<Far::TopologyRefiner> CreateRefiner(ControlMesh const& mesh,
                                                    std::vector<std::string>* warnings) {
    using Descriptor = Far::TopologyDescriptor;
    using Factory = Far::TopologyRefinerFactory<Descriptor>;

    std::vector<Descriptor::FVarChannel> channels(mesh.fvarChannels.size());
    for (size_t i = 0; i < channels.size(); ++i) {
        channels[i].numValues = mesh.fvarChannels[i].numValues;
        channels[i].valueIndices = mesh.fvarChannels[i].valueIndices.data();
    }
    Descriptor descriptor;
    descriptor.numVertices = mesh.numVertices;
    descriptor.numFaces = mesh.GetNumFaces();
    descriptor.numVertsPerFace = mesh.faceSizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();
    descriptor.numCreases = static_cast<int>(mesh.creaseSharpness.size());
    descriptor.creaseVertexIndexPairs = mesh.creaseVertexPairs.data();
    descriptor.creaseWeights = mesh.creaseSharpness.data();
    descriptor.numCorners = static_cast<int>(mesh.cornerSharpness.size());
    descriptor.cornerVertexIndices = mesh.cornerVertices.data();
    descriptor.cornerWeights = mesh.cornerSharpness.data();
    descriptor.numHoles = static_cast<int>(mesh.holes.size());
    descriptor.holeIndices = mesh.holes.data();
    descriptor.numFVarChannels = static_cast<int>(channels.size());
    descriptor.fvarChannels = channels.data();

    FarReportGuard guard;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(mesh.scheme, mesh.options)));
    guard.ThrowIfReported("building the topology");
    if (!refiner) throw Error(ErrorCode::BadMesh, "building the topology: OpenSubdiv made nothing");
    if (warnings) {
        warnings->insert(warnings->end(), guard.GetWarnings().begin(), guard.GetWarnings().end());
    }
    return refiner;
}

}  // namespace limn::far_ext
