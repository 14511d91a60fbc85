// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/bake/bake_options.h"

namespace limn::engine {

// How a bake's pattern becomes names of files. Tokens stand in braces or angle brackets: {map},
// {mesh}, {group}, and UDIM's in all its spellings (scene/udim).

/// Of pictures beside an EXR file, behind its name without an ending.
constexpr char const *kPictureEnding = ".png", *kLegendEnding = ".legend.png";

/// What the tokens of a pattern stand for.
struct OutputName {
    std::string map, mesh, group;
    std::optional<int> tile;  ///< none: the tile's token stays as it is
};

/// `pattern` with its tokens replaced. A map's or group's name becomes one part of a path.
std::string ExpandPattern(std::string const& pattern, OutputName const& name);

/// The beginning of names that stand for all tiles: `pattern` without its ending, the tile's token
/// and what parts this from the name: "out/head.mean." of "out/head.{map}.<UDIM>.exr".
std::string ExpandWithoutTile(std::string const& pattern, OutputName const& name);

inline bool HasMapToken(std::string_view pattern) {
    return pattern.find("{map}") != std::string_view::npos;
}
inline bool HasGroupToken(std::string_view pattern) {
    return pattern.find("{group}") != std::string_view::npos;
}

/// A map's or group's name where it becomes part of a path or of a channel's name.
std::string AsFileName(std::string name);

/// Refuses tokens that there are not. \throws Error BadOption, listing those there are
void CheckTokens(std::string const& pattern);

/// Refuses names that do not say EXR; the null device may have any.
/// \throws Error BadOption
void RequireExrEnding(std::string const& pattern);

/// The outputs of a run before anything is baked, to find those that are in each other's way.
class OutputNames {
public:
    /// Adds the outputs of one bake. \param mesh  its {mesh}; \param path  what messages call it
    /// \throws Error  BadOption: one of them is there already, or is no place for an EXR file
    void Add(BakeOptions const& options, std::string const& mesh, std::string const& path);

    /// Refuses a file that would be overwritten. \param what  it is, for the message: "the report"
    /// \throws Error  BadOption: it is an output
    void Refuse(std::string const& path, std::string const& what) const;

private:
    void AddPreviews(BakeOptions const& options, std::string const& file, std::string const& of);

    std::map<std::string, std::string> _owners;  // per file, without links and detours: what of
};

}  // namespace limn::engine
