// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/maps/map.h"

namespace limn::engine {

/// The channels of one output: a run of the bake's planes, plus perhaps coverage.
struct FileLayout {
    std::vector<MapTraits> maps;
    std::string mapName;  ///< for the {map} token and the report: "mean", or "mean+normal"
    int firstPlane = 0, numPlanes = 0;
    std::vector<std::string> channelNames;  ///< EXR names; coverage last
    std::vector<ChannelGroup> groups;       ///< of the planes, from 0

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
Attributes MakeAttributes(BakeOptions const& options, FileLayout const& file, Model const& model);

/// True if `path` is a file this bake would write again with the same content.
bool IsUpToDate(std::string const& path, Attributes const& attributes);

}  // namespace limn::engine
