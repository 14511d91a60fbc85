// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/output_names.h"
#include "engine/images/exr_rows.h"
#include "engine/images/png.h"
#include "engine/scene/sha256.h"

namespace limn::engine {

namespace {

namespace fs = std::filesystem;

// Remarks of a picture: what it was made by, and of which layer where maps share a file. No names
// of files, so that the same picture has the same bytes wherever it lies.
constexpr char const *kMadeKey = "limn:made", *kLayerKey = "limn:layer";

/// All that decides a picture, in one number.
std::string Digest(BakeOptions const& options, Attributes const& attributes) {
    std::string text = options.previewRange ? options.previewRange->GetText() : "";
    for (auto const& [name, value] : attributes) text += fmt::format("\n{}={}", name, value);
    return Sha256(text);
}

/// The remarks of a picture; none where there is no picture. What is no file (a pipe, say) is left
/// alone.
PngTexts ReadRemarks(std::string const& picture) {
    std::error_code ignored;
    return fs::is_regular_file(picture, ignored) ? ReadPngTexts(picture) : PngTexts();
}

/// \param layer  empty for a file's only map
bool IsPictureOf(std::string const& picture, std::string const& layer) {
    PngTexts texts = ReadRemarks(picture);
    return texts.contains(kMadeKey) && texts[kLayerKey] == layer;
}

}  // namespace

PreviewFiles::PreviewFiles(std::string const& path, FileLayout const& file,
                           BakeOptions const& options, Attributes const& attributes)
    : _stem(fs::path(path).replace_extension().string()),
      _made(Digest(options, attributes)),
      _hasLegends(options.hasPreviewLegend) {
    if (!options.hasPreview || FindOutputKind(path) != OutputKind::File) return;
    int firstChannel = 0;
    for (MapTraits const& map : file.maps) {
        Preview preview(map, firstChannel, options.width, options.height, options.previewRange,
                        options.encoding.value_or(Encoding{}));
        auto const channels = file.channelNames.begin() + firstChannel;
        firstChannel += map.GetNumChannels();
        int const numShown = preview.GetNumShown();
        std::string name = _stem, layer;
        if (file.maps.size() > 1) {
            layer = map.name;
            name.append(".").append(AsFileName(layer));
        }
        _previews.push_back({std::move(preview),
                             std::move(name),
                             std::move(layer),
                             {channels, channels + numShown}});
    }
}

std::vector<std::string> PreviewFiles::GetNames() const {
    std::vector<std::string> names;
    for (Named const& named : _previews) {
        names.push_back(named.name + kPictureEnding);
        if (_hasLegends) names.push_back(named.name + kLegendEnding);
    }
    return names;
}

bool PreviewFiles::AreUpToDate() const {
    return std::ranges::all_of(GetNames(), [&](std::string const& picture) {
        return ReadRemarks(picture)[kMadeKey] == _made;
    });
}

void PreviewFiles::Add(int firstRow, std::vector<TexelRowView> const& rows) {
    for (Named& named : _previews) {
        for (size_t row = 0; row < rows.size(); ++row)
            named.preview.Add(firstRow + static_cast<int>(row), rows[row]);
    }
}

void PreviewFiles::RemoveStale(Model const& model) const {
    std::vector<std::string> layers = ListFixedMapNames();
    for (Primvar const& primvar : model.GetPrimvars()) layers.push_back("primvar:" + primvar.name);
    auto const remove = [](std::string const& name, std::string const& layer) {
        for (char const* ending : {kPictureEnding, kLegendEnding}) {
            std::error_code ignored;
            if (IsPictureOf(name + ending, layer)) fs::remove(name + ending, ignored);
        }
    };
    remove(_stem, "");
    for (std::string const& layer : layers) remove(_stem + "." + AsFileName(layer), layer);
}

std::vector<std::unique_ptr<AtomicFile>> PreviewFiles::Write(std::string const& exr,
                                                             std::string const& of,
                                                             Job const& job) {
    std::vector<std::unique_ptr<AtomicFile>> files;
    auto const open = [&](std::string const& path) -> AtomicFile& {
        return *files.emplace_back(std::make_unique<AtomicFile>(path));
    };
    for (Named& named : _previews) {
        PngTexts texts{{kMadeKey, _made}};
        if (!named.layer.empty()) texts[kLayerKey] = named.layer;
        named.preview.Prepare();
        bool const needsValues = named.preview.NeedsValues();
        std::optional<ExrRows> rows;
        if (needsValues) rows.emplace(exr, named.channels);
        auto const fillRow = [&](int row, uint8_t* rgb) {
            job.CheckStopped();
            std::array<float const*, 3> values{};
            for (size_t c = 0; needsValues && c < named.channels.size(); ++c)
                values[c] = rows->GetRow(row, c);
            named.preview.DrawRow(row, values, rgb);
        };
        WritePngRows(open(named.name + kPictureEnding), named.preview.GetWidth(),
                     named.preview.GetHeight(), fillRow, texts);
        if (_hasLegends)
            WritePng(open(named.name + kLegendEnding), named.preview.GetColours().DrawLegend(of),
                     texts);
    }
    return files;
}

}  // namespace limn::engine
