// SPDX-License-Identifier: Apache-2.0
#include "engine/images/png.h"

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr size_t kLongestText = 1 << 16;

/// What the module calls; it is no place to throw through.
struct PngCallbacks {
    std::function<void(int row, uint8_t* rgb)> const& fillRow;
    AtomicFile& file;
    std::exception_ptr failure{};

    template <class Act>
    bool Try(Act act) {
        try {
            if (!failure) act();
        } catch (...) {
            failure = std::current_exception();
        }
        return !failure;
    }

    static bool Fill(void* user, int row, unsigned char* rgb) {
        auto& self = *static_cast<PngCallbacks*>(user);
        return self.Try([&] { self.fillRow(row, rgb); });
    }
    static bool Take(void* user, void const* bytes, size_t size) {
        auto& self = *static_cast<PngCallbacks*>(user);
        return self.Try([&] { self.file.Write({static_cast<char const*>(bytes), size}); });
    }
};

uint32_t ReadBigEndian(std::array<char, 4> const& bytes) {
    uint32_t value = 0;
    for (char const byte : bytes) value = value << 8 | static_cast<uint8_t>(byte);
    return value;
}

}  // namespace

void WritePng(AtomicFile& file, Picture const& picture, PngTexts const& texts) {
    size_t const rowSize = 3 * static_cast<size_t>(picture.GetWidth());
    WritePngRows(
        file, picture.GetWidth(), picture.GetHeight(),
        [&](int row, uint8_t* rgb) {
            std::copy_n(picture.GetPixels() + static_cast<size_t>(row) * rowSize, rowSize, rgb);
        },
        texts);
}

void WritePngRows(AtomicFile& file, int width, int height,
                  std::function<void(int row, uint8_t* rgb)> const& fillRow,
                  PngTexts const& texts) {
    std::vector<char const*> words;
    for (auto const& [key, text] : texts) words.insert(words.end(), {key.c_str(), text.c_str()});
    PngCallbacks callbacks{fillRow, file};
    std::array<char, 512> reason{};
    bool const isWritten = LoadImagesModule().encodePng(
        width, height, PngCallbacks::Fill, PngCallbacks::Take, &callbacks, words.data(),
        words.size() / 2, reason.data(), reason.size());
    if (callbacks.failure) std::rethrow_exception(callbacks.failure);
    if (!isWritten) {
        throw Error(ErrorCode::Io,
                    fmt::format("'{}' cannot be written: {}", file.GetPath(), reason.data()));
    }
}

PngTexts ReadPngTexts(std::string const& path) {
    PngTexts texts;
    std::ifstream file(path, std::ios::binary);
    std::array<char, 8> signature{};
    std::array<char, 4> size{}, kind{};
    if (!file.read(signature.data(), signature.size()) ||
        std::string_view(signature.data() + 1, 3) != "PNG")
        return texts;
    while (file.read(size.data(), size.size()) && file.read(kind.data(), kind.size())) {
        std::string_view const name(kind.data(), kind.size());
        uint32_t const length = ReadBigEndian(size);
        if (name == "IDAT" || name == "IEND") break;
        if (name != "tEXt" || length > kLongestText) {
            file.ignore(static_cast<std::streamsize>(length) + 4);  // and the check sum
            continue;
        }
        std::string text(length, '\0');
        if (!file.read(text.data(), static_cast<std::streamsize>(length))) break;
        size_t const end = text.find('\0');
        if (end != std::string::npos) texts[text.substr(0, end)] = text.substr(end + 1);
        file.ignore(4);
    }
    return texts;
}

}  // namespace limn::engine
