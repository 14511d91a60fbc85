// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/edit_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/io/file.h"
#include "engine/io/text_scanner.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

using Json = nlohmann::json;

/// An edit is an object of lists of objects of lists.
constexpr int kDeepest = 4;

/// A value as it can stand in a message: one line, at most 60 characters.
std::string Show(Json const& value) {
    constexpr size_t kMaxShown = 60;
    std::string text = value.dump(-1, ' ', /*ensure_ascii=*/true);
    if (text.size() > kMaxShown) text = text.substr(0, kMaxShown) + "...";
    return text;
}

class EditReader {
public:
    explicit EditReader(std::string const& path) : _path(path) {}

    CurvatureEdit Read() const {
        InputFile const file(_path);
        Json const json = Parse(file.GetBytes());
        if (!json.is_object()) Refuse("this is no JSON object");
        CurvatureEdit edit;
        for (auto const& [key, value] : json.items()) {
            if (key == "curvature") {
                RequireList(key, value);
                for (Json const& entry : value) {
                    edit.factors.push_back({VertexOf(key, entry), NumberOf(key, entry, "factor")});
                    CheckKeys(key, entry, 2);
                }
            } else if (key == "rotate") {
                RequireList(key, value);
                for (Json const& entry : value) {
                    edit.rotations.push_back(
                        {VertexOf(key, entry), AxisOf(entry), NumberOf(key, entry, "degrees")});
                    CheckKeys(key, entry, 3);
                }
            } else if (key == "filter") {
                if (value != "polarise")
                    Refuse(fmt::format("filter is {}; 'polarise' is possible", Show(value)));
                edit.isPolarised = true;
            } else {
                Refuse(fmt::format("key {} is not known; curvature, rotate and filter are",
                                   TextScanner::Quote(key)));
            }
        }
        return edit;
    }

private:
    Json Parse(std::string_view text) const {
        auto const limitDepth = [&](int depth, Json::parse_event_t, Json&) {
            if (depth > kDeepest)
                Refuse(fmt::format("values are nested more than {} deep", kDeepest));
            return true;
        };
        try {
            return Json::parse(text, limitDepth);
        } catch (Json::parse_error const& error) {
            auto const line = std::count(text.begin(), text.begin() + GetPlace(error, text), '\n');
            Refuse(fmt::format("line {} is no JSON", line + 1));
        } catch (Json::out_of_range const&) {
            Refuse("a number is too large");
        }
    }

    static std::ptrdiff_t GetPlace(Json::parse_error const& error, std::string_view text) {
        return static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    }

    [[noreturn]] void Refuse(std::string const& what) const {
        throw Error(ErrorCode::BadMesh, fmt::format("{}: {}", _path, what));
    }

    void RequireList(std::string const& key, Json const& value) const {
        if (!value.is_array()) Refuse(fmt::format("'{}' is no list", key));
    }

    /// All keys that are needed have been found; there must be no others.
    void CheckKeys(std::string const& key, Json const& entry, size_t count) const {
        if (entry.size() != count)
            Refuse(fmt::format("'{}': {} has unknown keys", key, Show(entry)));
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
            Refuse(fmt::format("'{}': {} has no number '{}'", key, Show(entry), name));
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
            Refuse(fmt::format("'rotate': {} has no axis of three numbers", Show(entry)));
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
