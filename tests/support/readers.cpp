// SPDX-License-Identifier: Apache-2.0
#include "support/readers.h"

#include <random>
#include <regex>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "engine/io/obj_reader.h"
#include "engine/io/off_reader.h"
#include "engine/io/ply_reader.h"
#include "far_ext/topology/control_mesh.h"
#include "support/values.h"

namespace limn::test {
namespace {

engine::Scene Parse(void (*read)(std::string_view, engine::Scene&), char const* path,
                    std::string const& text) {
    engine::Scene scene;
    scene.path = path;
    read(text, scene);
    return scene;
}

}  // namespace

engine::Scene ParseObj(std::string const& text) {
    return Parse(engine::ReadObj, "mesh.obj", text);
}

engine::Scene ParseOff(std::string const& text) {
    return Parse(engine::ReadOff, "mesh.off", text);
}

engine::Scene ParsePly(std::string const& bytes) {
    return Parse(engine::ReadPly, "mesh.ply", bytes);
}

std::string RefusalOfObj(std::string const& text) {
    return RefusalOf([&] { ParseObj(text); });
}

std::string RefusalOfOff(std::string const& text) {
    return RefusalOf([&] { ParseOff(text); });
}

std::string RefusalOfPly(std::string const& bytes) {
    return RefusalOf([&] { ParsePly(bytes); });
}

std::string WithCrlf(std::string const& text) {
    return std::regex_replace(text, std::regex("\n"), "\r\n");
}

size_t PeakMemory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

void PrintTo(Refusal const& refusal, std::ostream* out) {
    *out << refusal.name;
}

void ExpectRefusal(Refusal const& refusal, std::string const& message) {
    EXPECT_TRUE(message.starts_with(refusal.where)) << message;
    for (std::string const& part : refusal.says)
        EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
    EXPECT_LT(message.size(), 400u) << "a message is one line that can be read";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::string Damage(std::string text, unsigned seed) {
    std::mt19937 random(seed);
    for (unsigned i = 0; i <= seed % 3 && !text.empty(); ++i) {
        size_t const at = random() % text.size();
        switch (random() % 4) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, 1 + random() % 8);
                break;
            case 2:
                text.insert(at, text.substr(random() % text.size(), random() % 16));
                break;
            default:
                text[at] = "0123456789-/. \n"[random() % 15];
                break;
        }
    }
    return text;
}

std::string Garbage(std::string beginning, unsigned seed) {
    std::mt19937 random(seed);
    for (int i = 0; i < 2000; ++i) beginning += static_cast<char>(random());
    return beginning;
}

void ExpectSound(engine::Scene const& scene) {
    EXPECT_NO_THROW(far_ext::Validate(scene.cage));
    EXPECT_EQ(scene.positions.size(), 3 * static_cast<size_t>(scene.cage.numVertices));
    EXPECT_TRUE(AreFinite(scene.positions));
    EXPECT_TRUE(scene.faceLines.empty() || scene.faceLines.size() == scene.cage.faceSizes.size());
    if (scene.HasUVs()) {
        EXPECT_EQ(scene.uvs.size(),
                  2 * static_cast<size_t>(scene.cage.fvarChannels.at(0).numValues));
        EXPECT_TRUE(AreFinite(scene.uvs));
    }
    for (auto const& primvar : scene.primvars) {
        EXPECT_EQ(primvar.values.size(),
                  static_cast<size_t>(scene.cage.numVertices) * primvar.numChannels);
    }
}

DamageCounts ReadDamaged(std::string const& whole, int numCopies, std::string const& path,
                         std::function<engine::Scene(std::string const&)> const& read) {
    DamageCounts counts;
    std::regex const place(path + R"((:[0-9]+|: \S+ [0-9]+|: the file has no faces).*)");
    for (int seed = 0; seed < numCopies; ++seed) {
        SCOPED_TRACE(seed);
        engine::Scene scene;
        auto const error =
            CatchError([&] { scene = read(Damage(whole, static_cast<unsigned>(seed))); });
        if (!error) {
            ExpectSound(scene);
            ++counts.numRead;
            continue;
        }
        EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh) << error->what();
        EXPECT_TRUE(std::regex_match(error->what(), place)) << error->what();
        ++counts.numRefused;
    }
    return counts;
}

}  // namespace limn::test
