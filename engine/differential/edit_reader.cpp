// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/edit_reader.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

using Json = nlohmann::json;

/// Text cut to what fits a line of a terminal.
std::string Shorten(std::string const& text) {
    constexpr size_t kLongest = 60;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

/// A value for a message: its beginning, on one line, in ASCII.
std::string Quote(Json const& value) {
    return Shorten(value.dump(-1, ' ', /*ensure_ascii=*/true, Json::error_handler_t::replace));
}

class EditReader {
public:
    explicit EditReader(std::string const& path) : _path(path) {}

    CurvatureEdit Read() const {
        InputFile const file(_path);
        // Deep nesting would overflow the stack of whoever walks through the values.
        auto const checkDepth = [&](int depth, Json::parse_event_t, Json&) {
            if (depth > kDeepest)
                Refuse(
                    fmt::format("values are nested more than {} deep; an edit's are 4", kDeepest));
            return true;
        };
        Json const json = Json::parse(file.GetBytes(), checkDepth, /*allow_exceptions=*/false);
        if (!json.is_object()) Refuse("this is no JSON object");
        CurvatureEdit edit;
        for (auto const& [key, value] : json.items()) {
            if (key == "curvature") {
                for (Json const& entry : ListOf(key, value)) {
                    edit.factors.push_back({VertexOf(key, entry), NumberOf(key, entry, "factor")});
                    CheckKeys(key, entry, 2);
                }
            } else if (key == "rotate") {
                for (Json const& entry : ListOf(key, value)) {
                    edit.rotations.push_back(
                        {VertexOf(key, entry), AxisOf(entry), NumberOf(key, entry, "degrees")});
                    CheckKeys(key, entry, 3);
                }
            } else if (key == "filter") {
                if (value != "polarise")
                    Refuse(fmt::format("filter is {}; 'polarise' is possible", Quote(value)));
                edit.isPolarised = true;
            } else {
                Refuse(fmt::format("key {} is not known; curvature, rotate and filter are",
                                   Quote(key)));
            }
        }
        return edit;
    }

private:
    static constexpr int kDeepest = 16;

    [[noreturn]] void Refuse(std::string const& what) const {
        throw Error(ErrorCode::BadMesh, fmt::format("{}: {}", _path, what));
    }

    Json const& ListOf(std::string const& key, Json const& value) const {
        if (!value.is_array()) Refuse(fmt::format("'{}' is no list", key));
        return value;
    }

    /// All keys that are needed have been found; there must be no others.
    void CheckKeys(std::string const& key, Json const& entry, size_t count) const {
        if (entry.size() != count)
            Refuse(fmt::format("'{}': {} has unknown keys", key, Quote(entry)));
    }

    Index VertexOf(std::string const& key, Json const& entry) const {
        double const value = NumberOf(key, entry, "vertex");
        bool const isIndex =
            value == std::floor(value) && value >= 0.0 && value < std::numeric_limits<Index>::max();
        if (!isIndex) Refuse(fmt::format("'{}': vertex {} is no 0-based index", key, value));
        return static_cast<Index>(value);
    }

    double NumberOf(std::string const& key, Json const& entry, char const* name) const {
        if (!entry.is_object() || !entry.contains(name) || !entry[name].is_number()) {
            Refuse(fmt::format("'{}': {} has no number '{}'", key, Quote(entry), name));
        }
        return entry[name].get<double>();
    }

    std::array<double, 3> AxisOf(Json const& entry) const {
        bool const isAxis =
            entry.contains("axis") && entry["axis"].is_array() && entry["axis"].size() == 3;
        std::array<double, 3> axis{};
        for (size_t c = 0; isAxis && c < 3; ++c) {
            Json const& number = entry["axis"][c];
            axis[c] = number.is_number() ? number.get<double>() : 0.0;
        }
        if (!(std::hypot(axis[0], axis[1], axis[2]) > 0.0)) {
            Refuse(fmt::format("'rotate': {} has no axis of three numbers", Quote(entry)));
        }
        return axis;
    }

    std::string const& _path;
};

}  // namespace

CurvatureEdit ReadCurvatureEdit(std::string const& path) {
    return EditReader(path).Read();
}

}  // namespace limn::engine
