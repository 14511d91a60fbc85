// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace limn {

/// What kind of thing went wrong; the command line turns it into an exit status.
enum class ErrorCode {
    BadMesh,      ///< the content of an input is wrong: a mesh, a file, places, a value per vertex
    BadOption,    ///< a caller asked for something contradictory or out of range
    Unsupported,  ///< legal, but limn cannot do it
    TooLarge,     ///< a table would pass its index range
    Io            ///< could not read or write
};

/// A text with spaces in place of line ends and zero bytes, which names from outside may hold and
/// at which a message would end.
std::string MakeOneLine(std::string text);

/// The one exception limn throws on purpose. Its message is one line that names the thing, the
/// value and the bound. Thrown while reading, validating and building; inner loops never throw.
class Error : public std::runtime_error {
public:
    Error(ErrorCode code, std::string const& message)
        : std::runtime_error(MakeOneLine(message)), _code(code) {}

    ErrorCode GetCode() const noexcept { return _code; }

private:
    ErrorCode _code;
};

}  // namespace limn
