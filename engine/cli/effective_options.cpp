// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/effective_options.h"

namespace limn::cli {

using nlohmann::json;

namespace {

/// A number where the option takes numbers, else the text.
json ToValue(CLI::Option const& option, std::string const& text) {
    std::string const type = option.get_type_name();
    bool const isNumber =
        type.starts_with("INT") || type.starts_with("UINT") || type.starts_with("FLOAT");
    json const number = isNumber ? json::parse(text, nullptr, false) : json();
    return number.is_number() ? number : json(text);
}

/// Options that take several values have a list for a default.
bool IsList(std::string const& byDefault) {
    return byDefault.starts_with('[');
}

json DescribeDefault(CLI::Option const& option, std::string const& text) {
    if (text.empty()) return nullptr;
    json const list = IsList(text) ? json::parse(text, nullptr, false) : json();
    return list.is_array() ? list : ToValue(option, text);
}

json DescribeOption(CLI::Option const& option, std::string const& byDefault) {
    bool const isFlag = option.get_items_expected_max() == 0;
    if (isFlag && option.count() == 0) return false;
    if (isFlag) {  // some may have a value, as --half=MAP has
        std::string const text = option.results().back();
        return text == "true" ? json(true) : json(text);
    }
    if (option.count() == 0) return DescribeDefault(option, byDefault);
    auto const texts = option.reduced_results();
    if (!IsList(byDefault) && texts.size() == 1) return ToValue(option, texts[0]);
    json list = json::array();
    for (std::string const& text : texts) list.push_back(ToValue(option, text));
    return list;
}

}  // namespace

void TakeDefaults(CLI::App& verb, OptionDefaults& defaults) {
    for (CLI::Option* const option : verb.get_options()) {
        defaults[option] = option->get_default_str();
        option->default_str("");
    }
}

json DescribeOptions(CLI::App const& verb, OptionDefaults const& defaults) {
    json described = json::object();
    for (CLI::Option const* const option : verb.get_options()) {
        auto const& names = option->get_lnames();
        if (names.empty() || names[0] == "help" || names[0] == "version") continue;
        described[names[0]] = DescribeOption(*option, defaults.at(option));
    }
    return described;
}

}  // namespace limn::cli
