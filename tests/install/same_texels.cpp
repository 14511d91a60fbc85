// SPDX-License-Identifier: Apache-2.0
//
// Holds the texels that bake_to_memory prints to a file that has been baked, as OpenEXR reads it.

#include <cstdio>
#include <vector>

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

/// One channel of a file, [row][column].
std::vector<float> ReadChannel(Imf::InputFile& file, char const* channel, size_t width,
                               size_t height) {
    std::vector<float> texels(width * height);
    Imf::FrameBuffer buffer;
    buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(texels.data()),
                                      sizeof(float), sizeof(float) * width));
    file.setFrameBuffer(buffer);
    file.readPixels(0, static_cast<int>(height) - 1);
    return texels;
}

int main(int, char** argv) {
    Imf::InputFile file(argv[1]);
    auto const window = file.header().dataWindow();
    size_t const width = window.max.x + 1, height = window.max.y + 1;
    std::vector<float> const channels[3] = {ReadChannel(file, "R", width, height),
                                            ReadChannel(file, "G", width, height),
                                            ReadChannel(file, "B", width, height)};
    int numTexels = 0, numDifferent = 0, isInRow;
    for (char line[200]; std::fgets(line, sizeof line, stdin); numTexels += isInRow) {
        unsigned row = 0, column = 0;
        float texel[3];
        isInRow = std::sscanf(line, "row %u, column %u: %f %f %f", &row, &column, &texel[0],
                              &texel[1], &texel[2]) == 5;
        for (int c = 0; isInRow && c < 3; ++c)
            numDifferent += channels[c].at(row * width + column) != texel[c];
    }
    std::printf("%d texels, %d numbers differ\n", numTexels, numDifferent);
    return numTexels > 0 && numDifferent == 0 ? 0 : 1;
}
