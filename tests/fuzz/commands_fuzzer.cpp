// SPDX-License-Identifier: Apache-2.0
//
// End to end, as from a shell: bytes choose the words of a command line and the meshes they name.
// Whatever they are, the exit status is one of those that are promised, never that of a fault
// within.

#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cli/run_command.h"
#include "engine/io/mesh_writer.h"
#include "fuzz/choices.h"
#include "fuzz/fuzzer.h"
#include "fuzz/meshes.h"
#include "support/files.h"

namespace limn::fuzz {

namespace {

namespace fs = std::filesystem;

/// A verb with what must be said, and options that it has. '@' stands for the folder of outputs.
struct Verb {
    std::vector<char const*> needed;
    std::vector<char const*> options;
};

Verb const kVerbs[] = {
    {{"bake", "mesh", "-o@/{map}.<UDIM>.exr", "--size=16"},
     {"--maps=mean,normal",
      "--maps=curvature",
      "--maps=position",
      "--maps=noise",
      "--maps=stretch",
      "--maps=overlap",
      "--maps=bands",
      "--maps=displacement",
      "--maps=tension",
      "--maps=field",
      "--maps=all",
      "--against=other",
      "--rest=other",
      "--field=@/edges.csv",
      "--size=8x32",
      "--tiles=1001",
      "--tiles=1001-1003",
      "--samples=2",
      "--padding=2",
      "--half",
      "--half=normal",
      "--compression=piz",
      "--compression=none",
      "--mip",
      "--coverage",
      "--audit",
      "--audit-bound=1",
      "--seam-bound=normal=1",
      "--encode=2,0.5",
      "--vector",
      "--space=tangent",
      "--space=uv",
      "--normalize",
      "--groups=skin",
      "--noise-octaves=2",
      "--noise-seed=7",
      "--noise-ramp=#000000,#ffffff",
      "--skip-existing",
      "--bands=3",
      "-o@/{group}.{map}.exr",
      "-o@/one.exr",
      "other"}},
    {{"eval", "mesh", "--at=@/places.csv"},
     {"-o@/out.csv", "--evaluator=bfr", "--frames=other", "-o@/{frame}.csv", "--maps=noise",
      "--noise-seed=7", "--field=@/edges.csv", "--normalize", "--evaluator=osd-cpu",
      "--limit-stencils=far", "--far-level=2"}},
    {{"refine", "mesh", "-o@/out.obj", "--levels=1"},
     {"--levels=0",
      "--levels=2",
      "--limit",
      "--space=differential",
      "--rule=butterfly",
      "--rule=loop",
      "--laplacian=cotangent",
      "--laplacian=mesh",
      "--dirmag=1",
      "--handle=0",
      "--solver=cholesky",
      "--spatial-first=1",
      "--edit=@/edit.json",
      "--curve",
      "--keep-result",
      "-o@/out.ply",
      "--alpha=0.5",
      "--noise",
      "--noise-octaves=1",
      "--noise-at=vertex",
      "--noise-ramp=#000000,#ffffff",
      "--normalize"}},
    {{"fit", "mesh", "-o@/out.ply"},
     {"--tolerance=1e-3", "--tolerance=1e-12", "--method=cg", "--method=direct",
      "--method=weighted", "--method=progressive", "--method=chebyshev", "--max-iterations=3",
      "--alpha=0.5", "--keep-topology", "--keep-result", "--at-level=1", "--alpha-rule=stationary",
      "--limit-stencils=far", "--write-matrix=@/A.mtx"}},
    {{"bands", "mesh", "-o@/out"},
     {"--count=1", "--count=3", "--alpha=0.5", "--alpha-rule=stationary", "--gain=2",
      "--gain=1,-1,0.5", "--from=other", "--bands=0-2", "--bands=1-", "--carry=object"}},
    {{"denoise", "mesh", "-o@/out.obj"}, {"--detail=1", "--steps=3", "--alpha=0.5"}},
    {{"sharpen", "mesh", "-o@/out.obj"}, {"--from-band=1", "--to-band=3", "--steps=2"}},
    {{"morph", "mesh", "other", "-o@/out"},
     {"--detail=1", "--rate=0.5", "--steps=2", "--alpha=1", "--exact-end"}},
    {{"smooth", "mesh", "-o@/out.obj", "--levels=1"},
     {"--width=0.1",
      "--width-factor=0.5",
      "--local",
      "--width-scale=1",
      "--width-map=@/widths.csv",
      "--width-edges=@/edges.csv",
      "--refinement=bisect",
      "--solver=exact",
      "--solver=jacobi",
      "--sweeps=2",
      "--iterations=3",
      "--tolerance=1e-3",
      "--boundary-rule=natural",
      "--graph",
      "--keep-creases",
      "--preserve-volume",
      "--limit-width",
      "--keep-result",
      "--steps=3",
      "--settle=1e-3",
      "--adaptive=0.02"}},
    {{"field", "mesh", "-o@/out.obj"},
     {"--source=0",
      "--sink=1",
      "--vortex=0:2",
      "--harmonic=1,1",
      "--edges=@/edges.csv",
      "--match=@/vectors.csv",
      "--levels=1",
      "--at-boundary=normal",
      "--balance",
      "-o@/out.edges.csv",
      "-o@/out.faces.csv",
      "--values=@/values.csv",
      "--pin=0:1",
      "--integrals=@/integrals.csv",
      "--singularity=0:1",
      "--boundary-data=@/boundary.csv",
      "--loop=0:flux=1",
      "--arc-flux=0:1",
      "--write-stencils=@/S1.mtx,@/S2.mtx",
      "--along=@/along.csv",
      "-o@/out.along.csv",
      "-o@/out.values.csv",
      "-o@/out.integrals.csv",
      "--limit"}},
    {{"measure", "mesh"}, {"--surface=mesh", "-o@/out"}},
    {{"info", "mesh"}, {"--json"}},
    {{"combine", "mesh", "-o@/out.ply"},
     {"--scale=0", "--add=other", "--add=mesh:-0.5", "--offset=mesh,other", "--offset=other,mesh:2",
      "--carry=object", "--write-offset=d"}},
    {{"field", "mesh", "-o@/out.edges.csv", "--edges=@/edges.csv", "--streamlines=@/lines.obj",
      "--separation=0.3"},
     {"--streamlines=@/lines.csv", "--seeds=@/places.csv", "--separation=0.1",
      "--direction=forward", "--max-length=1", "--step=0.05", "--stop-distance=0.7", "--vortex=0:2",
      "--source=0", "--balance"}},
    {{"smooth", "mesh", "-o@/out.ply", "--levels=0"},
     {"--steps=3", "--settle=1e-3", "--order=4", "--keep-features=15%", "--width=0.1", "--local",
      "--preserve-volume", "--boundary-rule=natural", "--solver=exact", "--graph",
      "--keep-creases"}}};

std::vector<char const*> const kSharedOptions{"--scheme=loop",
                                              "--scheme=catmark",
                                              "--scheme=bilinear",
                                              "--boundary=none",
                                              "--boundary=edge-only",
                                              "--fvar=all",
                                              "--fvar=none",
                                              "--creases=chaikin",
                                              "--triangles=smooth",
                                              "--orientation=left",
                                              "--weld=0",
                                              "--weld=0.1",
                                              "--precision=double",
                                              "--report=@/report.json",
                                              "--verbose",
                                              "--report=-",
                                              "--progress=lines"};

char const* const kStrangeValues[] = {
    "nan",  "-1",  "1e999", "",    "0",        "99999999999999999999",
    "0x10", "1,2", "2k",    "inf", "\xff\xfe", "a b"};

/// Puts a folder's path in place of '@'.
std::string Expand(std::string_view word, std::string const& folder) {
    std::string text(word);
    for (size_t at = text.find('@'); at != text.npos; at = text.find('@', at + folder.size()))
        text.replace(at, 1, folder);
    return text;
}

/// Adds a word; one of the same option, as "-o@/a" or "--size=2", gives way.
void Say(std::vector<std::string>& words, std::string word) {
    auto const getOption = [](std::string const& w) {
        return w.substr(0, w.starts_with("-o") ? 2 : w.find('='));
    };
    auto const same = std::ranges::find(words, getOption(word), getOption);
    if (same == words.end())
        words.push_back(std::move(word));
    else
        *same = std::move(word);
}

std::vector<std::string> ChooseWords(Choices& choices, std::string const& folder) {
    Verb const& verb = choices.Pick(kVerbs);
    std::vector<std::string> words;
    for (char const* word : verb.needed) words.push_back(Expand(word, folder));
    for (int count = choices.TakeInt(0, 5); count > 0; --count) {
        auto const& options = choices.TakeOneIn(3) ? kSharedOptions : verb.options;
        std::string word = Expand(choices.Pick(options), folder);
        size_t const value = word.find('=');
        if (value != word.npos && choices.TakeOneIn(16))
            word = word.substr(0, value + 1) + choices.Pick(kStrangeValues);
        Say(words, std::move(word));
    }
    words.emplace_back("--threads=1");
    return words;
}

/// Two meshes in memory: "mesh", and "other", which is the same, moved.
class ChosenMeshes : public engine::MeshSource {
public:
    explicit ChosenMeshes(Choices& choices) : _mesh(ChooseMesh(choices)) {}

    engine::Scene Read(std::string const& name) override {
        if (name != "mesh" && name != "other")
            throw Error(ErrorCode::Io, "'" + name + "' cannot be opened: there is no such mesh");
        engine::Scene scene = _mesh;
        scene.path = scene.name = name;
        if (name == "other") {
            for (double& coordinate : scene.positions) coordinate *= 1.25;
        }
        return scene;
    }

private:
    engine::Scene _mesh;
};

void WriteInputs(test::TemporaryFolder const& folder) {
    folder.Write("places.csv", "face,s,t\n0,0.5,0.25\n0,0,0\n");
    folder.Write("edges.csv", "v0,v1,value,width\n0,1,0.5,0.25\n");
    folder.Write("widths.csv", "vertex,width\n0,0.25\n1,0\n");
    folder.Write("vectors.csv", "face,x,y,z\n0,1,0,0\n");
    folder.Write("along.csv", "v0,v1\n0,1\n");
    folder.Write("boundary.csv", "v0,v1,kind,value\n0,1,flux,0.5\n");
    folder.Write("values.csv", "vertex,value\n0,1\n1,0\n");
    folder.Write("integrals.csv", "face,value\n0,0.5\n");
    folder.Write("edit.json", R"({"curvature": [{"vertex": 0, "factor": 1.5}]})");
}

/// Requires a status that is promised and no files that should not be there, and removes what the
/// run has written.
void RequireOutcome(int status, bool isBake, test::TemporaryFolder const& folder,
                    std::vector<std::string> const& inputs) {
    Require(status == 0 || (status >= 2 && status <= 5), "a run ends with 0 or with 2 to 5");
    // Files of a bake that were complete before a fault stay.
    bool const mayHaveWritten = status == 0 || status == 4 || (isBake && status != 2);
    for (std::string const& name : folder.List()) {
        if (std::ranges::find(inputs, name) != inputs.end()) continue;
        Require(!name.ends_with(".tmp"), "a run leaves no temporary");
        Require(mayHaveWritten || name == "report.json", "what fails leaves nothing behind");
        fs::remove_all(folder / name);
    }
}

void RunOne(Choices& choices) {
    static test::TemporaryFolder const folder;
    static std::vector<std::string> const inputs = [] {
        WriteInputs(folder);
        return folder.List();
    }();
    std::vector<std::string> const words = ChooseWords(choices, folder.GetPath());
    ChosenMeshes meshes(choices);
    int const status = cli::RunCommand(words, meshes);
    RequireOutcome(status, words[0] == "bake", folder, inputs);
}

}  // namespace

}  // namespace limn::fuzz

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size) {
    using namespace limn::fuzz;
    UseOneThread();
    Choices choices({data, size});
    RunOne(choices);
    return 0;
}
