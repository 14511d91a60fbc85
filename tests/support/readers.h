// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <locale>
#include <ostream>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "engine/scene/scene.h"
#include "far_ext/topology/control_mesh.h"
#include "support/errors.h"
#include "support/values.h"

/// What the tests of the readers of mesh files share.
namespace limn::test {

inline std::string WithCrlf(std::string const& text) {
    return std::regex_replace(text, std::regex("\n"), "\r\n");
}

/// While it lives, numbers of C++'s streams have commas for points and points between thousands.
class CommaLocale {
public:
    CommaLocale() : _before(std::locale::global(std::locale(std::locale(), new Comma))) {}
    ~CommaLocale() { std::locale::global(_before); }
    CommaLocale(CommaLocale const&) = delete;
    CommaLocale& operator=(CommaLocale const&) = delete;

private:
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    std::locale _before;
};

/// Peak memory of this process so far, bytes.
inline size_t PeakMemory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

/// More than the small files of these tests need.
inline constexpr size_t kModestMemory = 64u << 20;

/// A text that is refused: what the message begins with, and what else it says.
struct Refusal {
    std::string name, text, where;
    std::vector<std::string> says;
};

inline void PrintTo(Refusal const& refusal, std::ostream* out) {
    *out << refusal.name;
}

inline void ExpectRefusal(Refusal const& refusal, std::string const& message) {
    EXPECT_TRUE(message.starts_with(refusal.where)) << message;
    for (std::string const& part : refusal.says)
        EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
    EXPECT_LT(message.size(), 400u) << "a message is one line that can be read";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// A text damaged in one to three places: bytes overwritten, removed or doubled, the same for the
/// same seed.
inline std::string Damage(std::string text, unsigned seed) {
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

/// Bytes without any meaning, after a beginning that has one.
inline std::string Garbage(std::string beginning, unsigned seed) {
    std::mt19937 random(seed);
    for (int i = 0; i < 2000; ++i) beginning += static_cast<char>(random());
    return beginning;
}

/// What a reader lets through: a cage that is valid, and finite values of the sizes that go with
/// it.
inline void ExpectSound(engine::Scene const& scene) {
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

/// How many damaged copies of a text became a scene, and how many were refused.
struct DamageCounts {
    int numRead = 0, numRefused = 0;
};

/// Reads damaged copies of a text: each is a sound scene, or refused as a bad mesh at a line or an
/// element of the file `path`.
inline DamageCounts ReadDamaged(std::string const& whole, int numCopies, std::string const& path,
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
