// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/sha256.h"

#include <array>
#include <new>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

namespace limn::engine {

struct Sha256Stream::Context {
    EVP_MD_CTX* const digest = EVP_MD_CTX_new();
    ~Context() { EVP_MD_CTX_free(digest); }
};

Sha256Stream::Sha256Stream() : _context(std::make_unique<Context>()) {
    // What can fail here is making room, first of all for what the library needs itself, without
    // which it does not fail but crash.
    if (!OSSL_LIB_CTX_get0_global_default() || !_context->digest ||
        !EVP_DigestInit_ex(_context->digest, EVP_sha256(), nullptr))
        throw std::bad_alloc();
}

Sha256Stream::~Sha256Stream() = default;

void Sha256Stream::Add(std::string_view bytes) {
    EVP_DigestUpdate(_context->digest, bytes.data(), bytes.size());
}

std::string Sha256Stream::Finish() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    EVP_DigestFinal_ex(_context->digest, digest.data(), &size);
    std::string text;
    for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
}

std::string Sha256(std::string_view bytes) {
    Sha256Stream stream;
    stream.Add(bytes);
    return stream.Finish();
}

}  // namespace limn::engine
