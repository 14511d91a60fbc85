// SPDX-License-Identifier: Apache-2.0
#include "engine/images/png.h"

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr size_t kLongestText = 1 << 16;

/// What the module calls for each row; it is no place to throw through.
struct RowSource {
    std::function<void(int row, uint8_t* rgb)> const& fillRow;
    std::exception_ptr failure{};

    static bool Fill(void* user, int row, unsigned char* rgb) {
        auto& source = *static_cast<RowSource*>(user);
        try {
            source.fillRow(row, rgb);
            return true;
        } catch (...) {
            source.failure = std::current_exception();
            return false;
        }
    }
};

uint32_t ReadBigEndian(std::array<char, 4> const& bytes) {
    uint32_t value = 0;
    for (char const byte : bytes) value = value << 8 | static_cast<uint8_t>(byte);
    return value;
}

}  // namespace

void WritePng(std::string const& path, Picture const& picture, PngTexts const& texts) {
    size_t const rowSize = 3 * static_cast<size_t>(picture.GetWidth());
    WritePngRows(
        path, picture.GetWidth(), picture.GetHeight(),
        [&](int row, uint8_t* rgb) {
            std::copy_n(picture.GetPixels() + static_cast<size_t>(row) * rowSize, rowSize, rgb);
        },
        texts);
}

void WritePngRows(std::string const& path, int width, int height,
                  std::function<void(int row, uint8_t* rgb)> const& fillRow,
                  PngTexts const& texts) {
    AtomicFile file(path);
    ImagesModule const& images = LoadImagesModule();
    std::vector<char const*> words;
    for (auto const& [key, text] : texts) words.insert(words.end(), {key.c_str(), text.c_str()});
    RowSource source{fillRow};
    std::array<char, 512> reason{};
    bool const isWritten =
        images.writePng(file.GetTemporaryPath().c_str(), width, height, RowSource::Fill, &source,
                        words.data(), words.size() / 2, reason.data(), reason.size());
    if (source.failure) std::rethrow_exception(source.failure);
    if (!isWritten) {
        throw Error(ErrorCode::Io, fmt::format("'{}' cannot be written: {}", path, reason.data()));
    }
    file.Commit();
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
