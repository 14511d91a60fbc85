// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <locale>
#include <ostream>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "support/errors.h"

/// What the tests of the readers of mesh files share.
namespace limn::test {

/// A scene from the text of a file that is called mesh.obj, mesh.off or mesh.ply.
engine::Scene ParseObj(std::string const& text);
engine::Scene ParseOff(std::string const& text);
engine::Scene ParsePly(std::string const& bytes);

/// What they say of a file that they refuse; empty if they read it.
std::string RefusalOfObj(std::string const& text);
std::string RefusalOfOff(std::string const& text);
std::string RefusalOfPly(std::string const& bytes);

inline std::string const kObjQuadVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
inline std::string const kObjQuad = kObjQuadVertices + "f 1 2 3 4\n";
inline std::string const kOffQuad = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
inline std::string const kPlyTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 "
    "1 2\n";

std::string WithCrlf(std::string const& text);

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
size_t PeakMemory();

/// More than the small files of these tests need.
inline constexpr size_t kModestMemory = 64u << 20;

/// A text that is refused: what the message begins with, and what else it says.
struct Refusal {
    std::string name, text, where;
    std::vector<std::string> says;
};

void PrintTo(Refusal const& refusal, std::ostream* out);

void ExpectRefusal(Refusal const& refusal, std::string const& message);

/// A text damaged in one to three places: bytes overwritten, removed or doubled, the same for the
/// same seed.
std::string Damage(std::string text, unsigned seed);

/// Bytes without any meaning, after a beginning that has one.
std::string Garbage(std::string beginning, unsigned seed);

/// What a reader lets through: a cage that is valid, and finite values of the sizes that go with
/// it.
void ExpectSound(engine::Scene const& scene);

/// How many damaged copies of a text became a scene, and how many were refused.
struct DamageCounts {
    int numRead = 0, numRefused = 0;
};

/// Reads damaged copies of a text: each is a sound scene, or refused as a bad mesh at a line or an
/// element of the file `path`.
DamageCounts ReadDamaged(std::string const& whole, int numCopies, std::string const& path,
                         std::function<engine::Scene(std::string const&)> const& read);

}  // namespace limn::test
