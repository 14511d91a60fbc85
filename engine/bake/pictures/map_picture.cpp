// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/pictures/map_picture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <system_error>
#include <tuple>

#include <fmt/format.h>

#include "engine/bake/maps/map_colours.h"
#include "engine/bake/output_names.h"
#include "engine/bake/pictures/seen_surface.h"
#include "engine/bake/raster/uv_raster.h"
#include "engine/images/exr_lookup.h"
#include "engine/images/png.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

namespace fs = std::filesystem;

constexpr int kSamplesPerSide = 2;               // of a pixel
constexpr char const* kMapKey = "limn:picture";  // a remark of the picture: which map it shows

/// One map of a bake, and the files that hold it.
struct ShownMap {
    MapTraits const& map;
    std::vector<std::string> channels;      ///< that are shown, in the files
    std::map<int, std::string> pathOfTile;  ///< of the files
    std::string picture;                    ///< its path
};

std::vector<ShownMap> ListMaps(Model const& model, BakeOptions const& options,
                               BakeReport const& report) {
    std::vector<ShownMap> maps;
    for (FileLayout const& file : report.files) {
        std::string const stem = ExpandWithoutTile(
            options.pattern,
            {.map = file.mapName, .mesh = model.GetName(), .group = options.group});
        auto channel = file.channelNames.begin();
        for (MapTraits const& map : file.maps) {
            MapColours const colours(map, {}, {});
            bool const isAlone = file.maps.size() == 1;
            ShownMap shown{map,
                           {channel, channel + colours.GetNumShown()},
                           {},
                           stem + (isAlone ? "" : AsFileName(map.name) + ".") + "picture.png"};
            channel += map.GetNumChannels();
            for (BakeOutput const& output : report.outputs) {
                if (output.map == file.mapName) shown.pathOfTile[output.tile] = output.path;
            }
            maps.push_back(std::move(shown));
        }
    }
    return maps;
}

/// Between two counts, or two lines of opposite signs, there is nothing.
bool WantsClosestTexel(MapTraits const& map) {
    return std::ranges::any_of(map.GetGroups(), [](ChannelGroup const& group) {
        return group.averaging == Averaging::Count || group.averaging == Averaging::Line;
    });
}

/// Values of one map at what is seen.
class SeenValues {
public:
    SeenValues(std::vector<SeenPlace> const& seen, ShownMap const& shown,
               BakeOptions const& options, Job const& job);

    bool Has(size_t sample) const { return _has[sample]; }
    std::array<float, 3> const& Get(size_t sample) const { return _values[sample]; }

private:
    std::vector<std::array<float, 3>> _values;
    std::vector<char> _has;
};

/// Which samples lie in a file, ordered by tiles of their texels, so that each is read once.
std::vector<size_t> OrderByTexels(std::vector<SeenPlace> const& seen, ShownMap const& shown,
                                  BakeOptions const& options) {
    std::vector<size_t> order;
    for (size_t sample = 0; sample < seen.size(); ++sample) {
        if (shown.pathOfTile.contains(seen[sample].tile)) order.push_back(sample);
    }
    auto const key = [&](size_t sample) {
        SeenPlace const& place = seen[sample];
        auto const tileAt = [](float coordinate, int texels) {
            return std::floor(coordinate * static_cast<float>(texels) / ExrSpec::kTileSize);
        };
        return std::tuple(place.tile, -tileAt(place.v, options.height),
                          tileAt(place.u, options.width), sample);
    };
    std::ranges::sort(order, {}, key);
    return order;
}

SeenValues::SeenValues(std::vector<SeenPlace> const& seen, ShownMap const& shown,
                       BakeOptions const& options, Job const& job)
    : _values(seen.size()), _has(seen.size(), 0) {
    bool const isClosest = WantsClosestTexel(shown.map);
    ExrLookup lookup;
    for (size_t sample : OrderByTexels(seen, shown, options)) {
        if (sample % 4096 == 0) job.CheckStopped();
        SeenPlace const& place = seen[sample];
        auto const grid = TileGrid::OfTile(place.tile, options.width, options.height);
        double x = grid.ToX(static_cast<double>(place.u)),
               y = grid.ToY(static_cast<double>(place.v));
        if (isClosest) {
            x = std::floor(x + 0.5);
            y = std::floor(y + 0.5);
        }
        auto const values = lookup.Look(shown.pathOfTile.at(place.tile), shown.channels, x, y);
        for (size_t c = 0; c < values.size(); ++c)
            _values[sample][c] = static_cast<float>(values[c]);
        _has[sample] = 1;
    }
}

/// The surface in the map's colours, `size` pixels wide and high.
Picture DrawSurface(std::vector<SeenPlace> const& seen, SeenValues const& values,
                    MapColours const& colours, int size) {
    constexpr Colour kNoMap{0.6f, 0.6f, 0.6f};
    constexpr float kBackground = kPictureBackground / 255.0f,
                    kAmbient = 0.4f,  // so that colours can be told in the shade, too
        kShare = 1.0f / (kSamplesPerSide * kSamplesPerSide);
    Picture picture(size, size);
    auto const add = [&](size_t sample, Colour& pixel) {
        bool const isSurface = seen[sample].IsSurface();
        Colour const colour = values.Has(sample) ? colours.FindColour(values.Get(sample)) : kNoMap;
        for (size_t c = 0; c < 3; ++c) {
            float const light = kAmbient + (1.0f - kAmbient) * seen[sample].shade;
            float const lit = std::clamp(colour[c], 0.0f, 1.0f) * light;
            pixel[c] += kShare * (isSurface ? lit : kBackground);
        }
    };
    size_t const width = static_cast<size_t>(size) * kSamplesPerSide;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            Colour pixel{};
            for (size_t j = 0; j < kSamplesPerSide; ++j) {
                for (size_t i = 0; i < kSamplesPerSide; ++i)
                    add((static_cast<size_t>(y) * kSamplesPerSide + j) * width +
                            static_cast<size_t>(x) * kSamplesPerSide + i,
                        pixel);
            }
            picture.Set(x, y, pixel);
        }
    }
    return picture;
}

Picture DrawMap(std::vector<SeenPlace> const& seen, ShownMap const& shown,
                BakeOptions const& options, std::string const& of, int size, Job const& job) {
    SeenValues const values(seen, shown, options, job);
    MapColours colours(shown.map, options.previewRange, options.encoding.value_or(Encoding{}));
    for (size_t sample = 0; sample < seen.size(); ++sample) {
        for (int c = 0; values.Has(sample) && c < colours.GetNumShown(); ++c)
            colours.Add(c, values.Get(sample)[c]);
    }
    colours.Prepare();
    return Stack(DrawSurface(seen, values, colours, size), colours.DrawLegend(of, size));
}

}  // namespace

std::vector<std::string> WriteMapPictures(Model const& model, BakeOptions const& options,
                                          BakeReport const& report, PictureView const& view,
                                          Job& job) {
    auto const maps = ListMaps(model, options, report);
    for (ShownMap const& shown : maps) {
        if (MapColours(shown.map, {}, {}).HasColours()) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`picture`: a {} in texture coordinates has no colours; `space` "
                                "object has",
                                shown.map.name));
    }
    auto const seen = LookAtSurface(model, options.groups, options.orientation, view,
                                    view.size * kSamplesPerSide, job);
    std::string const of =
        options.group.empty() ? model.GetName() : model.GetName() + " " + options.group;
    std::vector<std::unique_ptr<AtomicFile>> files;
    std::vector<std::string> paths;
    for (ShownMap const& shown : maps) {
        Picture const picture = DrawMap(seen, shown, options, of, view.size, job);
        files.push_back(std::make_unique<AtomicFile>(shown.picture));
        WritePng(*files.back(), picture, {{kMapKey, shown.map.name}});
        paths.push_back(shown.picture);
    }
    CommitTogether(files);
    return paths;
}

void RemoveMapPictures(Model const& model, BakeOptions const& options, BakeReport const& report) {
    bool const isAnyNew =
        std::ranges::any_of(report.outputs, [](auto const& output) { return !output.wasSkipped; });
    if (!isAnyNew) return;
    for (ShownMap const& shown : ListMaps(model, options, report)) {
        auto const texts = ReadPngTexts(shown.picture);
        auto const map = texts.find(kMapKey);
        std::error_code ignored;
        if (map != texts.end() && map->second == shown.map.name) fs::remove(shown.picture, ignored);
    }
}

}  // namespace limn::engine
