// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/option_list.h"

#include "engine/cli/options/choices.h"
#include "engine/cli/options/offered_words.h"

namespace limn::cli {

namespace {

OptionEntry::Value FindValue(CLI::Option const& option, OptionEntry const& entry) {
    if (option.get_items_expected_max() == 0) return OptionEntry::Value::None;
    if (!entry.words.empty()) return OptionEntry::Value::Words;
    bool const isNumber =
        entry.placeholder.starts_with("INT") || entry.placeholder.starts_with("FLOAT");
    return isNumber ? OptionEntry::Value::Number : OptionEntry::Value::Other;
}

}  // namespace

OptionEntry MakeOptionEntry(CLI::Option const& option) {
    OptionEntry entry;
    if (!option.get_snames().empty()) entry.shortFlag = "-" + option.get_snames()[0];
    if (!option.get_lnames().empty()) entry.longFlag = "--" + option.get_lnames()[0];
    entry.placeholder = option.get_type_name();
    entry.help = option.get_description();
    entry.group = option.get_group();
    entry.words = SplitChoices(entry.placeholder);
    entry.isList = option.get_delimiter() != '\0';
    if (entry.words.empty()) {
        OfferedWords const offered = FindOfferedWords(entry.longFlag);
        entry.words = offered.words;
        entry.isList |= offered.isList;
    }
    entry.value = FindValue(option, entry);
    if (entry.IsPositional()) entry.placeholder = option.get_name();
    return entry;
}

std::string OptionEntry::JoinFlags() const {
    return shortFlag.empty() || longFlag.empty() ? shortFlag + longFlag
                                                 : shortFlag + ", " + longFlag;
}

std::vector<OptionEntry> ListOptions(CLI::App const& app) {
    std::vector<OptionEntry> options;
    for (CLI::Option const* const option : app.get_options())
        options.push_back(MakeOptionEntry(*option));
    return options;
}

std::vector<CLI::App const*> ListVerbs(CLI::App const& app) {
    return app.get_subcommands([](CLI::App const*) { return true; });
}

std::vector<OptionEntry> ListCommonOptions(CLI::App const& app) {
    auto options = ListOptions(*ListVerbs(app).at(0));
    std::erase_if(options, [](OptionEntry const& option) { return !option.IsCommon(); });
    return options;
}

std::vector<std::string> ListFlags(std::vector<OptionEntry> const& options) {
    std::vector<std::string> flags;
    for (OptionEntry const& option : options) {
        for (std::string const& flag : {option.shortFlag, option.longFlag}) {
            if (!flag.empty()) flags.push_back(flag);
        }
    }
    return flags;
}

}  // namespace limn::cli
