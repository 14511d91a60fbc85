// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace limn::engine {

/// SHA-256 of bytes that come piece by piece.
class Sha256Stream {
public:
    Sha256Stream();
    ~Sha256Stream();
    Sha256Stream(Sha256Stream const&) = delete;
    Sha256Stream& operator=(Sha256Stream const&) = delete;

    void Add(std::string_view bytes);

    /// 64 hexadecimal digits. Called once, as the last.
    std::string Finish();

private:
    struct Context;

    std::unique_ptr<Context> _context;
};

/// SHA-256 of bytes, as 64 hexadecimal digits.
std::string Sha256(std::string_view bytes);

}  // namespace limn::engine
