// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/cli/cli.h"
#include "engine/field/field.h"

namespace limn::cli {

/// The flags that say what a field is made of.
class FieldInputs {
public:
    /// Adds the flags to a verb, which this outlives.
    void Add(CLI::App& verb);

    std::vector<NamedFile> ListFiles() const;
    int GetLevels() const { return _options.levels; }

    /// Reads what they name. \throws Error  BadOption: no part at all, a word that is none
    engine::FieldOptions MakeOptions(Far::TopologyLevel const& level) const;

private:
    void AddParts(CLI::App& verb);
    void AddMatches(CLI::App& verb);
    void AddFunctions(CLI::App& verb);
    void AddBoundaries(CLI::App& verb);
    void RequirePart(engine::FieldOptions const& options) const;

    std::string _edgesPath, _matchPath, _texturePattern, _harmonics, _valuesPath, _integralsPath,
        _boundaryPath;
    bool _isFlow = false;
    std::vector<std::string> _sources, _sinks, _vortices, _pins, _singularities, _loops, _arcFluxes;
    engine::FieldOptions _options;
};

}  // namespace limn::cli
