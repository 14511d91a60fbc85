// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace limn::test {

inline std::string ReadText(std::filesystem::path const& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void WriteText(std::string const& path, std::string const& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

/// A folder of its own, gone with its owner.
class TemporaryFolder {
public:
    /// mkdtemp puts a name of its own in place of the six letters.
    TemporaryFolder()
        : _path((std::filesystem::temp_directory_path() / "limn_").string() + std::string(6, 'X')) {
        if (!::mkdtemp(_path.data())) throw std::runtime_error("no temporary folder");
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::string const& GetPath() const { return _path; }
    std::string operator/(std::string const& name) const { return _path + "/" + name; }

    /// Writes a file and returns its path.
    std::string Write(std::string const& name, std::string const& text) const {
        WriteText(*this / name, text);
        return *this / name;
    }

    /// Names of everything in it, hidden files too, sorted.
    std::vector<std::string> List() const {
        std::vector<std::string> names;
        for (auto const& entry : std::filesystem::directory_iterator(_path)) {
            names.push_back(entry.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    std::string _path;
};

}  // namespace limn::test
