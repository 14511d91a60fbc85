// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "engine/images/images_module.h"

namespace {

bool Fail(std::string const& why, char* reason, size_t reasonSize) {
    std::snprintf(reason, reasonSize, "%s", why.c_str());
    return false;
}

/// What OpenImageIO takes for a file.
class Taker : public OIIO::Filesystem::IOProxy {
public:
    using Take = bool (*)(void* user, void const* bytes, size_t size);

    Taker(Take take, void* user) : IOProxy("", Write), _take(take), _user(user) {}

    char const* proxytype() const override { return "taker"; }
    size_t write(void const* bytes, size_t size) override {
        m_pos += static_cast<int64_t>(size);
        return _take(_user, bytes, size) ? size : 0;
    }

private:
    Take _take;
    void* _user;
};

bool EncodePng(int width, int height, bool (*fillRow)(void* user, int row, unsigned char* rgb),
               Taker::Take take, void* user, char const* const* texts, size_t numTexts,
               char* reason, size_t reasonSize) {
    auto const output = OIIO::ImageOutput::create("png");
    if (!output) return Fail(OIIO::geterror(), reason, reasonSize);
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    // Pictures of maps are smooth: more than this saves a tenth and takes twice as long.
    spec.attribute("png:compressionLevel", 3);
    for (size_t i = 0; i < numTexts; ++i) spec.attribute(texts[2 * i], texts[2 * i + 1]);
    Taker taker(take, user);
    if (!output->set_ioproxy(&taker) || !output->open("", spec))
        return Fail(output->geterror(), reason, reasonSize);
    std::vector<unsigned char> rgb(3 * static_cast<size_t>(width));
    for (int row = 0; row < height; ++row) {
        if (!fillRow(user, row, rgb.data())) return Fail("stopped", reason, reasonSize);
        if (!output->write_scanline(row, 0, OIIO::TypeDesc::UINT8, rgb.data()))
            return Fail(output->geterror(), reason, reasonSize);
    }
    return output->close() || Fail(output->geterror(), reason, reasonSize);
}

/// The first channel that has one of the names, or 0 without names; none if there is no such.
std::optional<int> FindChannel(OIIO::ImageSpec const& spec, char const* const* names,
                               size_t numNames) {
    if (numNames == 0) return 0;
    for (size_t i = 0; i < numNames; ++i) {
        int const channel = spec.channelindex(names[i]);
        if (channel >= 0) return channel;
    }
    return {};
}

bool ReadChannels(char const* path, char const* const* firstNames, size_t numNames, int numChannels,
                  float* (*allocate)(void*, int, int), void* user, char* reason,
                  size_t reasonSize) {
    auto const input = OIIO::ImageInput::open(path);
    if (!input) return Fail(OIIO::geterror(), reason, reasonSize);
    OIIO::ImageSpec const& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        return Fail("it has no pixels in two dimensions", reason, reasonSize);
    auto const first = FindChannel(spec, firstNames, numNames);
    if (!first) return Fail(std::string("it has no channel ") + firstNames[0], reason, reasonSize);
    if (*first + numChannels > spec.nchannels) {
        return Fail("it has no " + std::to_string(numChannels) + " channels from " +
                        std::string(spec.channel_name(*first)) + " on",
                    reason, reasonSize);
    }
    float* const pixels = allocate(user, spec.width, spec.height);
    if (!input->read_image(0, 0, *first, *first + numChannels, OIIO::TypeDesc::FLOAT, pixels))
        return Fail(input->geterror(), reason, reasonSize);
    return true;
}

}  // namespace

extern "C" limn::engine::ImagesModule const* limn_images_module() {
    static limn::engine::ImagesModule const module{EncodePng, ReadChannels};
    return &module;
}
