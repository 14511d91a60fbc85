// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/terminal/manual.h"

#include <fmt/format.h>

#include "engine/cli/options/option_list.h"
#include "engine/version.h"

namespace limn::cli {

namespace {

constexpr char const* kStatus = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
An internal error, or out of memory.
.TP
.B 2
The command line makes no sense: an unknown option, a bad value, a contradiction.
.TP
.B 3
Bad input: the content of a file, or a vertex, face or edge that does not exist.
.TP
.B 4
It ran, and missed what was asked: a solver did not converge, an audit missed its bound.
.TP
.B 5
Something could not be read or written.
.TP
.B 130, 143
Interrupted; nothing half-written is left.
)";

constexpr char const* kEnvironment = R"(.SH ENVIRONMENT
.TP
.B LIMN_THREADS, OPENIMAGEIO_THREADS, CUE_THREADS
How many threads to use where
.B \-\-threads
is not given; the first that is set counts. The first is refused if it is no number from 1 to 1024,
the others are passed over then. Results do not depend on it.
.TP
.B LIMN_SIMD
.BR sse2 " or " avx2 :
the kernels of this instruction set rather than the widest the processor has. Results do not depend
on it.
.TP
.B COLUMNS
The most columns of a terminal that a bar of progress may take.
)";

/// Text in which roff sees no commands, and leaves every dash and quote as it is typed.
std::string Escape(std::string_view text) {
    std::string escaped;
    bool isLineStart = true;
    for (char c : text) {
        if (isLineStart && (c == '.' || c == '\'')) escaped += "\\&";
        isLineStart = c == '\n';
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else if (c == '\'')
            escaped += "\\(aq";
        else
            escaped += c;
    }
    return escaped;
}

std::string DescribeInManual(OptionEntry const& option) {
    std::string const value =
        option.value == OptionEntry::Value::None ? "" : " " + option.placeholder;
    return option.IsPositional()
               ? fmt::format(".TP\n\\fI{}\\fR\n{}\n", Escape(option.placeholder),
                             Escape(option.help))
               : fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", Escape(option.JoinFlags()), Escape(value),
                             Escape(option.help));
}

/// A verb with all options that are its own, and the examples that end its help.
std::string DescribeVerbInManual(CLI::App const& verb) {
    std::string text =
        fmt::format(".SS limn {}\n{}.\n", verb.get_name(), Escape(verb.get_description()));
    for (OptionEntry const& option : ListOptions(verb)) {
        if (!option.IsCommon()) text += DescribeInManual(option);
    }
    if (!verb.get_footer().empty())
        text += fmt::format(".PP\n.nf\n{}\n.fi\n", Escape(verb.get_footer()));
    return text;
}

}  // namespace

std::string WriteManual(CLI::App const& app) {
    std::string text =
        fmt::format(".TH LIMN 1 \"\" \"limn {}\" \"User Commands\"\n", Escape(kVersion));
    text += ".SH NAME\nlimn \\- " + Escape("evaluate and bake the limit of subdivision surfaces") +
            "\n.SH SYNOPSIS\n.B limn\n.I VERB\n[\\fIARGUMENT\\fR...] [\\fIOPTION\\fR...]\n"
            ".SH DESCRIPTION\n" +
            Escape(app.get_description()) + "\n.SH OPTIONS\n";
    for (OptionEntry const& option : ListOptions(app)) text += DescribeInManual(option);
    text += ".SS Options every verb shares\n";
    for (OptionEntry const& option : ListCommonOptions(app)) text += DescribeInManual(option);
    text += ".SH VERBS\n";
    for (CLI::App const* const verb : ListVerbs(app)) text += DescribeVerbInManual(*verb);
    return text + kStatus + kEnvironment;
}

}  // namespace limn::cli
