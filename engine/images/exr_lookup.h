// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace limn::engine {

/// Bilinear look-ups in finished EXR files, tile by tile, with a bounded cache. Not for threads.
class ExrLookup {
public:
    ExrLookup();
    ~ExrLookup();

    /// Channels at texel coordinates (x, y), whole numbers at texel centres; beyond the border the
    /// nearest texel counts.
    ///
    /// \param channels  names in the file
    /// \throws Error    Io
    std::vector<double> Look(std::string const& path, std::vector<std::string> const& channels,
                             double x, double y);

private:
    struct File;
    File& Open(std::string const& path, std::vector<std::string> const& channels);
    float const* FetchTexel(File& file, int x, int y);

    std::map<std::string, std::unique_ptr<File>> _files;
};

}  // namespace limn::engine
