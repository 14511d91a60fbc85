// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/bake/bake.h"
#include "engine/bake/mip_chain.h"

namespace limn::engine {

/// The channels of one output file: a run of the bake's planes, plus perhaps coverage.
struct FileLayout {
    std::vector<Map> maps;
    std::string mapName;  ///< for the {map} token and the report: "mean", or "mean+normal"
    int firstPlane = 0, numPlanes = 0;
    std::vector<std::string> channelNames;  ///< EXR names; coverage last
    std::vector<ChannelGroup> groups;       ///< of the planes, from 0
};

/// One file per map where the pattern has {map}, else one file with a layer per map.
std::vector<FileLayout> LayOutFiles(std::vector<Map> const& maps, std::string const& pattern,
                                    bool hasCoverage);

/// The options that decide pixels, in canonical form: what makes two runs' files equal.
std::string MakeOptionText(BakeOptions const& options, FileLayout const& file, Scene const& scene);

/// Header attributes of a file, [Bake 7].
std::vector<std::pair<std::string, std::string>> MakeAttributes(BakeOptions const& options,
                                                                FileLayout const& file,
                                                                Scene const& scene,
                                                                Scene const* other);

/// True if `path` is a file this bake would write again with the same content.
bool IsUpToDate(std::string const& path,
                std::vector<std::pair<std::string, std::string>> const& attributes);

bool HasUdimToken(std::string const& pattern);

}  // namespace limn::engine
