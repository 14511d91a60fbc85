// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/parse_faults.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace limn::cli {

namespace {

/// Words what CLI11 has found, which its messages tell in words of its own.
class FaultWords {
public:
    FaultWords(CLI::App const& verb,
               std::function<std::string(CLI::Option const&)> const& findExample)
        : _verb(verb), _findExample(findExample) {}

    std::string Describe(CLI::ParseError const& error) const {
        std::string_view const message = error.what();
        std::string words;
        if (dynamic_cast<CLI::ArgumentMismatch const*>(&error))
            words = DescribeCount(message);
        else if (dynamic_cast<CLI::RequiredError const*>(&error))
            words = DescribeMissing();
        else if (dynamic_cast<CLI::RequiresError const*>(&error))
            words = DescribeNeed();
        else if (dynamic_cast<CLI::ExcludesError const*>(&error))
            words = DescribeContradiction();
        else if (dynamic_cast<CLI::ConversionError const*>(&error))
            words = DescribeFlag(message);
        return words.empty() ? std::string(message) : words;
    }

private:
    template <class Fits>
    CLI::Option const* Find(Fits fits) const {
        auto const options = _verb.get_options();
        auto const found = std::ranges::find_if(options, fits);
        return found == options.end() ? nullptr : *found;
    }

    /// ", such as --size 2048"
    std::string Suggest(CLI::Option const& option) const {
        std::string const example = _findExample(option);
        if (example.empty()) return {};
        bool const hasFlag = option.nonpositional();
        return fmt::format(", such as {}{}", hasFlag ? option.get_name() + " " : "", example);
    }

    /// Too few values of an option, or too many. \param message  begins with its name and a colon
    std::string DescribeCount(std::string_view message) const {
        auto const* const option = Find([&](CLI::Option const* candidate) {
            return message.starts_with(candidate->get_name() + ":");
        });
        if (!option) return {};
        std::string const name = option->get_name();
        size_t const count = option->results().size();
        int const wanted = option->get_items_expected_max();
        if (count == 0) return fmt::format("{} needs a value{}", name, Suggest(*option));
        if (wanted == 1) return fmt::format("{} takes one value and has {}", name, count);
        return fmt::format("{} takes {} values and has {}{}", name, wanted, count,
                           Suggest(*option));
    }

    std::string DescribeMissing() const {
        auto const* const missing = Find([](CLI::Option const* option) {
            return option->get_required() && option->count() == 0;
        });
        if (!missing) return {};
        return fmt::format("{} is required{}", missing->get_name(), Suggest(*missing));
    }

    std::string DescribeNeed() const {
        for (CLI::Option const* option : _verb.get_options()) {
            if (option->count() == 0) continue;
            for (CLI::Option const* needed : option->get_needs()) {
                if (needed->count() > 0) continue;
                return fmt::format("{} needs {}{}", option->get_name(), needed->get_name(),
                                   Suggest(*needed));
            }
        }
        return {};
    }

    std::string DescribeContradiction() const {
        for (CLI::Option const* option : _verb.get_options()) {
            if (option->count() == 0) continue;
            for (CLI::Option const* other : option->get_excludes()) {
                if (other->count() == 0) continue;
                return fmt::format("{} and {} exclude each other", option->get_name(),
                                   other->get_name());
            }
        }
        return {};
    }

    /// Of flags alone, for values of options are read by limn itself.
    std::string DescribeFlag(std::string_view message) const {
        auto const* const flag = Find([&](CLI::Option const* option) {
            return option->count() > 0 &&
                   message.find(" " + option->get_name() + " = ") != message.npos;
        });
        return flag ? fmt::format("{} takes no value", flag->get_name()) : "";
    }

    CLI::App const& _verb;
    std::function<std::string(CLI::Option const&)> const& _findExample;
};

}  // namespace

std::string DescribeFault(CLI::App const& verb, CLI::ParseError const& error,
                          std::function<std::string(CLI::Option const&)> const& findExample) {
    return FaultWords(verb, findExample).Describe(error);
}

}  // namespace limn::cli
