// SPDX-License-Identifier: Apache-2.0
//
// Every picture of the pages has the command that makes it on its page, and that command has what
// it needs in the repository. scripts/pictures.sh runs these commands.

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/source_tree.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// README.md and docs/*.md.
std::vector<fs::path> ListPages() {
    std::vector<fs::path> pages{test::kSourceRoot / "README.md"};
    for (auto const& entry : fs::directory_iterator(test::kSourceRoot / "docs")) {
        if (entry.path().extension() == ".md") pages.push_back(entry.path());
    }
    return pages;
}

/// The pictures that a page shows, as files.
std::set<fs::path> ListPictures(fs::path const& page) {
    std::set<fs::path> pictures;
    std::string const text = test::ReadText(page);
    std::regex const pattern(R"(!\[[^\]]*\]\(([^)]*)\))");
    for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
        pictures.insert((page.parent_path() / (*at)[1].str()).lexically_normal());
    return pictures;
}

/// The words of a line as a shell has them, quotes taken away.
Words SplitWords(std::string const& line) {
    Words words;
    std::string word;
    char quote = 0;
    for (char c : line + " ") {
        if (quote ? c == quote : c == '\'' || c == '"') {
            quote = quote ? 0 : c;
        } else if (!quote && c == ' ') {
            if (!word.empty()) words.push_back(word);
            word.clear();
        } else {
            word += c;
        }
    }
    return words;
}

/// The commands of a page that write to out/: what is indented by four, joined at backslashes.
std::vector<Words> ListCommands(fs::path const& page) {
    std::vector<Words> commands;
    std::istringstream text(test::ReadText(page));
    std::string joined;
    for (std::string line; std::getline(text, line);) {
        if (!line.starts_with("    ")) continue;
        joined += line.substr(line.find_first_not_of(' '));
        if (joined.ends_with('\\')) {
            joined.pop_back();
            continue;
        }
        bool const isRun = joined.starts_with("limn ") || joined.starts_with("./limn ") ||
                           joined.starts_with("awk ");
        if (isRun && joined.find("out/") != std::string::npos)
            commands.push_back(SplitWords(joined));
        joined.clear();
    }
    return commands;
}

/// The word behind a flag; empty without it.
std::string Behind(Words const& command, std::string const& flag) {
    auto const at = std::ranges::find(command, flag);
    return at == command.end() || at + 1 == command.end() ? "" : *(at + 1);
}

bool Has(Words const& command, std::string const& flag) {
    return std::ranges::find(command, flag) != command.end();
}

std::string Replace(std::string text, std::string const& token, std::string const& by) {
    size_t const at = text.find(token);
    return at == std::string::npos ? text : text.replace(at, token.size(), by);
}

/// The pictures that a command leaves, for the ways in which the pages name them.
std::set<std::string> ListMade(Words const& command) {
    std::set<std::string> made;
    std::string const output = Behind(command, "-o"), picture = Behind(command, "--picture");
    if (picture.ends_with(".png")) made.insert(picture);
    std::string const& verb = command.at(1);
    if (verb == "measure") {
        std::string const map = picture == "gaussian" ? picture : "mean";
        if (Has(command, "--picture")) made.insert(fmt::format("{}.{}.png", output, map));
        if (Has(command, "--highlight")) made.insert(output + ".highlight.png");
    }
    if (verb != "bake") return made;
    std::istringstream maps(Behind(command, "--maps"));
    for (std::string map; std::getline(maps, map, ',');) {
        std::string const name = Replace(output, "{map}", Replace(map, ":", "_"));
        if (Has(command, "--preview"))
            made.insert(Replace(Replace(name, "<UDIM>", "1001"), ".exr", ".png"));
        if (Has(command, "--picture"))
            made.insert(Replace(Replace(name, ".<UDIM>", ""), ".exr", ".picture.png"));
    }
    return made;
}

/// Words that name files which a command reads: those in scenes/, tests/ and out/.
Words ListInputs(Words const& command) {
    Words inputs;
    for (size_t i = 1; i < command.size(); ++i) {
        bool const isWritten = command[i - 1] == "-o" || command[i - 1] == "--picture" ||
                               command[i - 1] == "--report" || command[i - 1] == "--streamlines" ||
                               command[i].starts_with('>');
        if (isWritten) continue;
        for (char const* folder : {"scenes/", "tests/", "out/"}) {
            if (command[i].starts_with(folder)) inputs.push_back(command[i]);
        }
    }
    return inputs;
}

/// Whether a command has written a file, which may be one of several of a prefix or a table beside
/// a mesh.
bool IsWrittenBy(Words const& command, std::string const& file) {
    std::string const stem = fs::path(Behind(command, "-o")).replace_extension().string();
    return Has(command, ">" + file) || (!stem.empty() && file.starts_with(stem));
}

TEST(Pictures, EachHasTheCommandThatMakesItOnItsPage) {
    size_t numPictures = 0;
    for (fs::path const& page : ListPages()) {
        std::set<std::string> made;
        for (Words const& command : ListCommands(page)) made.merge(ListMade(command));
        for (fs::path const& picture : ListPictures(page)) {
            ++numPictures;
            EXPECT_TRUE(fs::exists(picture)) << page << ": " << picture;
            auto const images = test::kSourceRoot / "docs" / "images";
            std::string const name = "out/" + fs::relative(picture, images).string();
            EXPECT_TRUE(made.contains(name)) << page << ": no command makes " << name;
        }
    }
    EXPECT_GT(numPictures, 40u);
}

TEST(Pictures, CommandsReadWhatIsThereOrWasMadeBefore) {
    for (fs::path const& page : ListPages()) {
        auto const commands = ListCommands(page);
        for (size_t i = 0; i < commands.size(); ++i) {
            for (std::string const& input : ListInputs(commands[i])) {
                bool const isMade =
                    std::any_of(commands.begin(), commands.begin() + static_cast<ptrdiff_t>(i),
                                [&](Words const& earlier) { return IsWrittenBy(earlier, input); });
                EXPECT_TRUE(isMade || fs::exists(test::kSourceRoot / input))
                    << page << ": " << fmt::format("{}", commands[i].at(1)) << " reads " << input;
            }
        }
    }
}

TEST(Pictures, NoneLiesThereForNoPage) {
    std::set<fs::path> shown;
    for (fs::path const& page : ListPages()) shown.merge(ListPictures(page));
    for (auto const& entry :
         fs::recursive_directory_iterator(test::kSourceRoot / "docs" / "images")) {
        bool const isShown = shown.contains(entry.path().lexically_normal());
        EXPECT_TRUE(isShown || entry.is_directory()) << entry.path();
    }
}

}  // namespace
}  // namespace limn
