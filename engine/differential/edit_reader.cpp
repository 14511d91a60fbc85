// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/edit_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <vector>

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
        for (auto const& [key, value] : json.items()) ReadKey(key, value, edit);
        return edit;
    }

private:
    void ReadKey(std::string const& key, Json const& value, CurvatureEdit& edit) const {
        if (key == "filter") return ReadFilter(value, edit);
        std::set<Index> setVertices;
        auto const forEach = [&](size_t numKeys, auto add) {
            RequireList(key, value);
            for (Json const& entry : value) {
                Index const vertex = VertexOf(key, entry);
                // What is set twice would keep the last value, and nobody would know.
                bool const isSetTwice =
                    key.starts_with("set_") && !setVertices.insert(vertex).second;
                if (isSetTwice) Refuse(fmt::format("'{}' names vertex {} twice", key, vertex));
                add(vertex, entry);
                CheckKeys(key, entry, numKeys);
            }
        };
        if (key == "set_curvature") {
            forEach(2, [&](Index vertex, Json const& entry) {
                edit.means.push_back({vertex, NumberOf(key, entry, "mean")});
            });
        } else if (key == "curvature") {
            forEach(2, [&](Index vertex, Json const& entry) {
                edit.factors.push_back({vertex, NumberOf(key, entry, "factor")});
            });
        } else if (key == "set_normal") {
            forEach(2, [&](Index vertex, Json const& entry) {
                edit.normals.push_back({vertex, DirectionOf(key, entry, "normal")});
            });
        } else if (key == "rotate") {
            forEach(3, [&](Index vertex, Json const& entry) {
                edit.rotations.push_back(
                    {vertex, DirectionOf(key, entry, "axis"), NumberOf(key, entry, "degrees")});
            });
        } else {
            Refuse(
                fmt::format("key {} is not known; curvature, set_curvature, rotate, set_normal "
                            "and filter are",
                            TextScanner::Quote(key)));
        }
    }

    void ReadFilter(Json const& value, CurvatureEdit& edit) const {
        if (value == "polarise") {
            edit.isPolarised = true;
            return;
        }
        if (!value.is_object() || !value.contains("points") || value.size() != 1) {
            Refuse(
                fmt::format("filter is {}; 'polarise' is possible, or {{\"points\": [[x, y], "
                            "...]}}",
                            Show(value)));
        }
        Json const& points = value["points"];
        RequireList("points", points);
        double last = -1.0;
        for (Json const& point : points) {
            bool const isPoint = point.is_array() && point.size() == 2 && point[0].is_number() &&
                                 point[1].is_number();
            if (!isPoint) Refuse(fmt::format("filter: {} is no point [x, y]", Show(point)));
            double const x = point[0].get<double>();
            if (!(x >= 0.0 && x <= 1.0) || x <= last) {
                Refuse(
                    fmt::format("filter: x of {} is not in [0, 1], or does not rise", Show(point)));
            }
            edit.filterPoints.push_back({x, point[1].get<double>()});
            last = x;
        }
        if (edit.filterPoints.size() < 2) Refuse("filter: a curve needs two points at least");
    }

    Json Parse(std::string_view text) const {
        std::vector<std::set<std::string>> keys;  // of the objects that are being read
        auto const check = [&](int depth, Json::parse_event_t event, Json& parsed) {
            if (depth > kDeepest)
                Refuse(fmt::format("values are nested more than {} deep", kDeepest));
            if (event == Json::parse_event_t::object_start) keys.emplace_back();
            if (event == Json::parse_event_t::object_end) keys.pop_back();
            // Of equal keys a JSON object would keep the last, and nobody would know.
            bool const isDoubled = event == Json::parse_event_t::key &&
                                   !keys.back().insert(parsed.get<std::string>()).second;
            if (isDoubled)
                Refuse(fmt::format("key {} stands twice in one object",
                                   TextScanner::Quote(parsed.get<std::string>())));
            return true;
        };
        try {
            return Json::parse(text, check);
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

    std::array<double, 3> DirectionOf(std::string const& key, Json const& entry,
                                      char const* name) const {
        bool const isList =
            entry.contains(name) && entry[name].is_array() && entry[name].size() == 3;
        std::array<double, 3> direction{};
        for (size_t c = 0; isList && c < 3; ++c) {
            Json const& number = entry[name][c];
            direction[c] = number.is_number() ? number.get<double>() : 0.0;
        }
        if (!(std::hypot(direction[0], direction[1], direction[2]) > 0.0)) {
            Refuse(fmt::format("'{}': {} has no {}: three numbers, not all 0", key, Show(entry),
                               name));
        }
        return direction;
    }

    std::string const& _path;
};

}  // namespace

CurvatureEdit ReadCurvatureEdit(std::string const& path) {
    return EditReader(path).Read();
}

}  // namespace limn::engine
