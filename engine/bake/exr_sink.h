// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/bake/bake_options.h"
#include "engine/bake/texel_sink.h"

namespace limn::engine {

/// Writes a bake's outputs as EXR files, named by the options' pattern; with mip levels and
/// previews where these are asked for. Files appear one by one, each complete or not at all.
class ExrDestination : public BakeDestination {
public:
    /// Both are kept by reference.
    ExrDestination(Model const& model, BakeOptions const& options)
        : _model(model), _options(options) {}

    /// \throws Error  Io
    std::unique_ptr<TexelSink> Open(FileLayout const& file, BakeOutput& output) override;

private:
    Model const& _model;
    BakeOptions const& _options;
};

}  // namespace limn::engine
