# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE=<checkout> -D OUTPUT=<file> -P WriteCommit.cmake: writes a source that defines
# limn::cli::kCommit, the commit that is checked out. In a release without history, or where its
# folder lies in another project's history, that is empty.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel --short=12 HEAD
    OUTPUT_VARIABLE answer OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
string(REPLACE "\n" ";" answer "${answer}")
set(commit "")
if(status EQUAL 0)
    list(GET answer 0 top)
    file(REAL_PATH ${SOURCE} source)
    if(top STREQUAL source)
        list(GET answer 1 commit)
    endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
// SPDX-License-Identifier: Apache-2.0
namespace limn::cli {

extern char const* const kCommit;
char const* const kCommit = "@commit@";

}  // namespace limn::cli
]])
file(TOUCH ${OUTPUT})  # it is up to date now
