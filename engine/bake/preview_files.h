// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/layout.h"
#include "engine/bake/preview.h"
#include "engine/bake/texel_sink.h"
#include "engine/io/atomic_file.h"
#include "engine/scene/job.h"

namespace limn::engine {

/// The pictures beside an EXR file of a bake: NAME.png, or NAME.MAP.png where maps share the file,
/// with a legend each where that is asked for: NAME.legend.png. Each says in its remarks that limn
/// has made it and by which options, so that those of an earlier file of the name are known.
class PreviewFiles {
public:
    /// \param path        of the EXR file
    /// \param attributes  its header's
    PreviewFiles(std::string const& path, FileLayout const& file, BakeOptions const& options,
                 Attributes const& attributes);

    bool IsAnyWanted() const { return !_previews.empty(); }

    /// Paths of all pictures and legends that are wanted.
    std::vector<std::string> GetNames() const;

    /// Whether all pictures that are wanted are there already, made of the same file.
    bool AreUpToDate() const;

    /// Takes rows as they are written, with their coverage.
    void Add(int firstRow, std::vector<TexelRowView> const& rows);

    /// Removes pictures of an earlier file of the name. \param model  whose primvars may have some
    void RemoveStale(Model const& model) const;

    /// Draws what the finished file holds, for the caller to commit.
    ///
    /// \param exr      the file, wherever it is for the time being
    /// \param of       what the maps are of, for legends
    /// \throws Error   Io
    /// \throws Stopped
    std::vector<std::unique_ptr<AtomicFile>> Write(std::string const& exr, std::string const& of,
                                                   Job const& job);

private:
    struct Named {
        Preview preview;
        std::string name;                   // without an ending
        std::string layer;                  // the map, where maps share the file
        std::vector<std::string> channels;  // in the EXR file
    };

    std::string _stem, _made;
    bool _hasLegends;
    std::vector<Named> _previews;
};

}  // namespace limn::engine
