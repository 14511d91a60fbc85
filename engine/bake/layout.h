// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/maps/map.h"
#include "engine/images/exr_seal.h"

namespace limn::engine {

/// The channels of one output: a run of the bake's planes, plus perhaps coverage.
struct FileLayout {
    std::vector<MapTraits> maps;
    std::string mapName;  ///< for the {map} token and the report: "mean", or "mean+normal"
    int firstPlane = 0, numPlanes = 0;
    std::vector<std::string> channelNames;  ///< EXR names; coverage last
    std::vector<ChannelGroup> groups;       ///< of the planes, from 0

    /// What is taken off the positions in it, where that was asked for.
    std::optional<std::array<double, 3>> FindOrigin() const;

    /// Per channel, whether it is written with 16 bits; coverage is where all maps are.
    std::vector<char> FindHalfChannels(BakeOptions const& options) const;
};

/// One file per map where the pattern has {map}, else one file with a layer per map.
std::vector<FileLayout> LayOutFiles(std::vector<std::unique_ptr<Map>> const& maps,
                                    std::string const& pattern, bool hasCoverage);

/// The options that decide pixels, in canonical form: what makes two runs' files equal.
std::string MakeOptionText(BakeOptions const& options, FileLayout const& file, Model const& model);

/// Header attributes of a file [Bake 7].
using Attributes = std::vector<std::pair<std::string, std::string>>;
Attributes MakeAttributes(BakeOptions const& options, FileLayout const& file, Model const& model,
                          int tile);

/// The range of values of a file that a bake would write again with the same content: its header
/// has these attributes, and every byte is as it was written.
///
/// \param check  called now and then; what it throws ends the work
/// \return       nothing for another file, or none
std::optional<ValueRange> FindUpToDate(std::string const& path, Attributes const& attributes,
                                       std::function<void()> const& check = {});

}  // namespace limn::engine
