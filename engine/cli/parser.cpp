// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/parser.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "engine/cli/names.h"
#include "engine/cli/options/example_values.h"
#include "engine/cli/options/nearest_words.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_list.h"
#include "engine/cli/options/parse_faults.h"
#include "engine/cli/options/word_flag.h"
#include "engine/cli/options/word_option.h"
#include "engine/cli/terminal/completion.h"
#include "engine/cli/terminal/manual.h"
#include "engine/cli/version_text.h"
#include "engine/scene/subdivision_names.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

constexpr char const* kVersionHelp = "tell version and build";

void AddCommonOptions(CLI::App& app, CommonOptions& o) {
    auto const group = [&](CLI::Option* option) { option->group(kCommonGroup); };
    group(AddWordOption(app, "--scheme", o.scheme, engine::kSchemeWords, "default catmark"));
    group(AddWordOption(app, "--boundary", o.boundary, engine::kBoundaryWords,
                        "default: the file's tag, else edge-and-corner"));
    group(AddWordOption(app, "--fvar", o.fvar, engine::kFVarWords,
                        "how texture coordinates are subdivided (default: the file's tag, else "
                        "corners-plus1)"));
    group(AddWordOption(app, "--creases", o.creases, engine::kCreaseWords,
                        "default: the file's tag, else uniform"));
    group(AddWordOption(app, "--triangles", o.triangles, engine::kTriangleWords,
                        "default: the file's tag, else catmark"));
    group(AddNumberOption(app, "--weld", o.weld,
                          "join boundary vertices that lie within this length of each other (0: in "
                          "one place), as where an exporter has cut along texture seams"));
    group(AddWordOption(app, "--orientation", o.orientation, engine::kOrientationWords,
                        "right (default): faces are counter-clockwise from outside"));
    group(AddNumberOption(app, "--threads", o.numThreads,
                          "default: LIMN_THREADS, OPENIMAGEIO_THREADS, CUE_THREADS, else all cores",
                          kThreadCounts));
    group(
        app.add_option("--report", o.reportPath, "write a JSON report of the run (- for stdout)"));
    group(AddWordOption(app, "--precision", o.precision, kPrecisionWords,
                        "digits of output (default: float, of meshes far from the origin double)"));
    auto* const quiet = app.add_flag("--quiet", o.isQuiet, "no progress, no warnings");
    group(quiet);
    group(app.add_flag("--verbose", o.isVerbose,
                       "tell phases and their seconds, files and tiles on stderr")
              ->excludes(quiet));
    group(AddWordOption(app, "--progress", o.progress, kProgressWords,
                        "auto (default): a bar on a terminal, else lines"));
}

std::vector<std::string> ListNames(std::vector<CLI::App const*> const& verbs) {
    std::vector<std::string> names;
    for (CLI::App const* const verb : verbs) names.push_back(verb->get_name());
    return names;
}

bool IsFlag(std::string const& word) {
    return word.size() > 1 && word[0] == '-' && word != "--";
}

/// "--size" of "--size=64".
std::string GetFlag(std::string const& word) {
    return word.substr(0, word.find('='));
}

/// Of words that a verb did not take, the first that was meant to be an option; else the first.
std::string FindOffender(std::vector<std::string> const& words) {
    auto const flag = std::ranges::find_if(words, IsFlag);
    return flag == words.end() ? words[0] : *flag;
}

/// "-size" means --size, and "-o=a" -o a; as short options they would have the values "ize" and
/// "=a".
void RefuseSingleDashes(CLI::App const& verb, std::vector<std::string> const& words) {
    for (std::string const& word : words) {
        if (word == "--") return;
        if (word.size() < 3 || !IsFlag(word) || word[1] == '-') continue;
        if (word[2] == '=') {
            throw Error(ErrorCode::BadOption,
                        fmt::format("{}: '{}': write {} {}, without '='", verb.get_name(), word,
                                    word.substr(0, 2), word.substr(3)));
        }
        std::string const flag = "-" + GetFlag(word);
        if (!verb.get_option_no_throw(flag)) continue;
        throw Error(ErrorCode::BadOption, fmt::format("{}: no option '{}'; did you mean {}?",
                                                      verb.get_name(), flag.substr(1), flag));
    }
}

/// Refuses values that are empty, as of a shell's variable that is not set: they would count as if
/// the option were not there.
void RefuseEmptyValues(CLI::App const& verb) {
    for (CLI::Option const* const option : verb.get_options()) {
        auto const values = option->results();
        if (!option->nonpositional() || std::ranges::find(values, "") == values.end()) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("{}: '' is empty; give a value or leave the option out",
                                option->get_name(false, false)));
    }
}

/// Where a file is missing: the option, of a list, that may have taken it for one of its values.
std::string ExplainMissing(CLI::App const& verb) {
    auto const options = verb.get_options();
    bool const isMissing = std::ranges::any_of(options, [](CLI::Option const* option) {
        return option->get_positional() && option->get_required() && option->count() == 0;
    });
    auto const taker = std::ranges::find_if(options, [](CLI::Option const* option) {
        return option->nonpositional() && option->count() > 0 &&
               (option->get_items_expected_max() > 1 || option->get_allow_extra_args());
    });
    if (!isMissing || taker == options.end()) return "";
    return fmt::format("; files stand before {}, which takes all words that follow it",
                       (*taker)->get_name());
}

}  // namespace

Parser::Parser() {
    _app.set_help_flag("-h,--help", "tell this");  // of verbs, too
    _app.set_version_flag("--version", GetVersionText(), kVersionHelp);
    _app.require_subcommand(1);
    _app.get_formatter()->column_width(34);
    _app.get_formatter()->label("SUBCOMMAND", "VERB");
    _app.option_defaults()->always_capture_default();
    _verbs = {AddInfo(_app),    AddEval(_app),  AddBake(_app),    AddRefine(_app),
              AddMeasure(_app), AddFit(_app),   AddBands(_app),   AddDenoise(_app),
              AddSharpen(_app), AddMorph(_app), AddCombine(_app), AddSmooth(_app),
              AddField(_app)};
    for (Verb const& verb : _verbs) {
        verb.app->group("Verbs");
        verb.app->set_version_flag("--version", GetVersionText(), kVersionHelp);
        AddCommonOptions(*verb.app, _common);
        TakeDefaults(*verb.app, _defaults);
    }
    AddQuestions();
}

void Parser::AddQuestions() {
    auto const verbs = ListNames(ListVerbs(_app));
    auto const add = [&](char const* name, char const* help, std::function<std::string()> answer) {
        CLI::App* const app = _app.add_subcommand(name, help)->group("Of limn itself");
        _questions.push_back({app, std::move(answer)});
        return app;
    };
    auto* const help =
        add("help", "Tell about limn, or about a verb", [this] { return MakeHelp(_helpVerb); });
    help->add_option("VERB", _helpVerb, "the same as limn VERB --help")
        ->type_name(JoinChoices(verbs));
    add("version", "Tell version and build", [] { return GetVersionText() + "\n"; });
    auto* const completion =
        add("completion", "Write the script that lets a shell complete limn's command lines",
            [this] { return WriteCompletion(_app, _shell); });
    AddWordOption(*completion, "SHELL", _shell, kShellWords, "the shell")->required();
    add("manual", "Write limn's manual page (man -l shows it)",
        [this] { return WriteManual(_app); });
    for (Question const& question : _questions) TakeDefaults(*question.app, _defaults);
}

std::string Parser::MakeHelp(std::string const& verb) const {
    if (verb.empty())
        return _app.get_formatter()->make_help(&_app, "limn", CLI::AppFormatMode::Normal);
    RequireVerb(verb);
    return _app.get_subcommand(verb)->help("limn");
}

void Parser::RequireVerb(std::string const& word) const {
    auto const names = ListNames(ListVerbs(_app));
    if (std::ranges::find(names, word) != names.end()) return;
    throw Error(ErrorCode::BadOption, fmt::format("no verb '{}'{} (limn --help lists them)", word,
                                                  AskForNearest(word, names)));
}

void Parser::CheckBeginning(std::vector<std::string> const& arguments) const {
    std::string const& first = arguments[0];
    if (!IsFlag(first)) {
        RequireVerb(first);
        RefuseSingleDashes(*_app.get_subcommand(first), arguments);
    } else if (!_app.get_option_no_throw(first)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("no option '{}' before the verb; options follow it (limn --help "
                                "tells more)",
                                GetFlag(first)));
    }
}

std::optional<std::string> Parser::Parse(std::vector<std::string> const& typed) {
    if (!typed.empty()) CheckBeginning(typed);
    bool const hasVerb = !typed.empty() && !IsFlag(typed[0]);
    auto const arguments = hasVerb ? JoinWordFlags(*_app.get_subcommand(typed[0]), typed) : typed;
    try {
        _app.parse(
            std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // last one first
    } catch (CLI::Success const& asked) {                                     // help, version
        std::ostringstream out, err;
        _app.exit(asked, out, err);
        return out.str();
    } catch (CLI::ParseError const& error) {
        Refuse(error);
    }
    for (CLI::App const* const verb : _app.get_subcommands()) RefuseEmptyValues(*verb);
    auto const question =
        std::ranges::find_if(_questions, [](Question const& asked) { return asked.app->parsed(); });
    return question == _questions.end() ? std::nullopt : std::optional(question->answer());
}

/// Says what is wrong. An option that there is not comes before what is missing: it may be that.
void Parser::Refuse(CLI::ParseError const& error) const {
    auto const parsed = _app.get_subcommands();
    if (parsed.empty())
        throw Error(ErrorCode::BadOption, "a verb is required (limn --help lists them)");
    CLI::App const& verb = *parsed[0];
    std::string const tellsMore = fmt::format("(limn {} --help tells more)", verb.get_name());
    auto const offenders = verb.remaining();
    if (offenders.empty()) {
        auto const findExample = [&](CLI::Option const& option) {
            return FindExample(MakeOptionEntry(option), verb.get_name(), _defaults.at(&option));
        };
        throw Error(ErrorCode::BadOption,
                    fmt::format("{}{} {}", DescribeFault(verb, error, findExample),
                                ExplainMissing(verb), tellsMore));
    }
    std::string const offender = FindOffender(offenders);
    if (!IsFlag(offender)) {
        throw Error(ErrorCode::BadOption, fmt::format("{}: '{}' is one argument too many {}",
                                                      verb.get_name(), offender, tellsMore));
    }
    std::string const flag = GetFlag(offender);
    throw Error(ErrorCode::BadOption,
                fmt::format("{}: no option '{}'{} {}", verb.get_name(), flag,
                            AskForNearest(flag, ListFlags(ListOptions(verb))), tellsMore));
}

nlohmann::json Parser::DescribeVerbsOptions() const {
    return DescribeOptions(*GetVerb().app, _defaults);
}

Verb const& Parser::GetVerb() const {
    return *std::ranges::find_if(_verbs, [](Verb const& verb) { return verb.app->parsed(); });
}

}  // namespace limn::cli
