// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/bake/bake_options.h"
#include "engine/bake/texel_sink.h"
#include "engine/scene/job.h"

namespace limn::engine {

/// Writes a bake's outputs as EXR files, named by the options' pattern; with mip levels and
/// previews where these are asked for. Files appear one by one, each complete or not at all.
class ExrDestination : public BakeDestination {
public:
    /// All are kept by reference.
    ExrDestination(Model const& model, BakeOptions const& options, Job const& job)
        : _model(model), _options(options), _job(job) {}

    void CheckPlace(FileLayout const& file, int tile) const override;

    /// \throws Error  as ExrWriter
    std::unique_ptr<TexelSink> Open(FileLayout const& file, BakeOutput& output) override;

private:
    std::string NameFile(std::string const& map, int tile) const;
    bool IsThere(BakeOutput& output, Attributes const& attributes) const;

    Model const& _model;
    BakeOptions const& _options;
    Job const& _job;
};

}  // namespace limn::engine
