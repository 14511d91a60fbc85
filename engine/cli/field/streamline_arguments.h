// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "engine/cli/cli.h"
#include "engine/field/streamlines.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

/// The flags of streamlines: --streamlines and all that go with it.
class StreamlineArguments {
public:
    /// Adds the flags to a verb, which this outlives.
    void Add(CLI::App& verb);

    bool IsWanted() const { return !_output.empty(); }
    NamedFile GetInput() const { return {"--seeds", _seedsPath}; }
    NamedFile GetOutput() const { return {"--streamlines", _output}; }

    /// \throws Error  BadOption: a name that is no .obj or .csv; neither --separation nor --seeds;
    ///                flags without --streamlines
    void Check(CLI::App const& verb) const;

    /// Traces the lines and reports them.
    ///
    /// \param form       per edge of the mesh
    /// \param evaluator  of the run, or null
    engine::Streamlines Trace(engine::Model const& model, std::span<double const> form,
                              eval::TableEvaluator* evaluator, Context& context) const;

    void Write(engine::Model const& model, engine::Streamlines const& streamlines,
               Context const& context, engine::MeshSequence& files) const;

private:
    std::string _output, _seedsPath;
    engine::StreamlineOptions _options;
};

}  // namespace limn::cli
