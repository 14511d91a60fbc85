// SPDX-License-Identifier: Apache-2.0
#include "eval/streamlines/even_streamlines.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "eval/streamlines/face_sides.h"
#include "eval/streamlines/point_grid.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

/// Places all over a surface, and how far each is from the nearest line.
class Coverage {
public:
    Coverage(FlowSurface const& flow, double separation) : _reach(2.0 * separation), _grid(_reach) {
        ChoosePlaces(flow, separation);
        _positions.resize(_places.size());
        tbb::enumerable_thread_specific<FlowSurface::Sampler> samplers(
            [&] { return FlowSurface::Sampler(flow); });
        tbb::parallel_for(tbb::blocked_range<size_t>(0, _places.size(), 256), [&](auto const& r) {
            FlowSurface::Sampler& sampler = samplers.local();
            for (size_t i = r.begin(); i != r.end(); ++i) {
                sampler.Bind(_places[i].face);
                _positions[i] = sampler.Evaluate(_places[i].s, _places[i].t).position;
            }
        });
        _distances.assign(_places.size(), _reach);
        for (size_t i = 0; i < _places.size(); ++i) {
            _grid.Add(_positions[i], i);
            _farthest.push({_reach, i});
        }
    }

    void AddLine(Streamline const& line) {
        for (StreamPoint const& point : line.points) {
            _grid.FindNear(point.position, [&](Eigen::Vector3d const& place, size_t i) {
                _distances[i] = std::min(_distances[i], (place - point.position).norm());
                return false;
            });
        }
    }

    /// The farthest place of those not taken yet, if it is farther than a distance.
    std::optional<SurfacePlace> TakeFarthest(double distance) {
        while (!_farthest.empty()) {
            auto const [known, i] = _farthest.top();
            _farthest.pop();
            double const now = _distances[i];
            if (now <= distance) continue;
            if (now == known) return _places[i];
            _farthest.push({now, i});
        }
        return {};
    }

    double FindFarthest() const {
        return _distances.empty() ? 0.0 : *std::max_element(_distances.begin(), _distances.end());
    }

private:
    /// By distance, then by number.
    struct Far {
        double distance;
        size_t place;
        bool operator<(Far const& other) const {
            return distance != other.distance ? distance < other.distance : place > other.place;
        }
    };

    /// On each face a lattice whose neighbours are no more than half the separation apart.
    void ChoosePlaces(FlowSurface const& flow, double separation) {
        constexpr double kMostPlaces = 0x1p24;
        auto const& surface = flow.GetSurface();
        FaceSides const sides(surface.IsLoop());
        FlowSurface::Sampler sampler(flow);
        double count = 0.0;
        for (Index face = 0; face < surface.GetNumFaces(); ++face) {
            if (!surface.HasLimit(face)) continue;
            sampler.Bind(face);
            double longest = 0.0;
            for (int side = 0; side < sides.GetCount(); ++side) {
                auto const at = [&](double along) {
                    auto const place = sides.GetPlace(side, along);
                    return sampler.Evaluate(place[0], place[1]).position;
                };
                longest =
                    std::max(longest, (at(0.5) - at(0.0)).norm() + (at(1.0) - at(0.5)).norm());
            }
            double const parts = std::max(1.0, std::ceil(2.0 * longest / separation));
            count += (parts + 1.0) * (parts + 1.0);
            if (!(count <= kMostPlaces)) {
                throw Error(ErrorCode::TooLarge,
                            fmt::format("lines {:g} apart are too many for this surface; "
                                        "`separation` has to be larger",
                                        separation));
            }
            AddLattice(face, static_cast<int>(parts), surface.IsLoop());
        }
    }

    void AddLattice(Index face, int parts, bool isTriangle) {
        for (int j = 0; j <= parts; ++j) {
            for (int i = 0; i <= (isTriangle ? parts - j : parts); ++i) {
                _places.push_back(
                    {face, 0, static_cast<double>(i) / parts, static_cast<double>(j) / parts});
            }
        }
    }

    double _reach;
    std::vector<SurfacePlace> _places;
    std::vector<Eigen::Vector3d> _positions;
    std::vector<double> _distances;
    PointGrid<size_t> _grid;
    std::priority_queue<Far> _farthest;
};

class Filler {
public:
    Filler(FlowSurface const& flow, EvenOptions const& options)
        : _flow(flow),
          _options(options),
          _tracer(flow, options.line.step, options.line.leastSpeed),
          _across(flow, 0.25 * options.separation, options.line.leastSpeed),
          _coverage(flow, options.separation),
          _points(options.separation) {}

    void Fill() {
        if (auto const first = FindFastest()) AddLine(*first, _options.separation);
        size_t next = 0;
        while (true) {
            for (; next < _lines.size(); ++next) SeedBeside(next);
            auto const far = _coverage.TakeFarthest(_options.separation);
            if (!far) break;
            AddLine(*far, _options.separation);
        }
    }

    void Trace(std::span<SurfacePlace const> seeds) {
        for (SurfacePlace const& seed : seeds) AddLine(seed, 0.0);
    }

    EvenLines Finish() {
        EvenLines result;
        if (!_lines.empty()) result.farthest = _coverage.FindFarthest();
        result.lines = std::move(_lines);
        return result;
    }

private:
    bool IsNear(Eigen::Vector3d const& place, double distance) const {
        return _points.FindNear(place, [&](Eigen::Vector3d const& point, char) {
            return (point - place).norm() < distance;
        });
    }

    std::optional<SurfacePlace> FindFastest() const {
        auto const speeds = _flow.FindSpeeds();
        auto const fastest = std::max_element(speeds.begin(), speeds.end());
        if (fastest == speeds.end() || !(*fastest > 0.0)) return {};
        auto const vertex = static_cast<Index>(fastest - speeds.begin());
        auto const faces = _flow.GetLevel().GetVertexFaces(vertex);
        auto const corners = _flow.GetLevel().GetVertexFaceLocalIndices(vertex);
        int i = 0;
        while (!_flow.GetSurface().HasLimit(faces[i])) ++i;
        return GetCornerPlace(_flow.GetSurface(), faces[i], corners[i]);
    }

    void AddLine(SurfacePlace const& seed, double shortest) {
        if (_options.line.onSteps) _options.line.onSteps();
        double const nearest = _options.stopDistance * _options.separation;
        if (IsNear(_tracer.MakeStart(seed).position, nearest)) return;
        Apartness const apartness{_options.separation, nearest, [&](Eigen::Vector3d const& point) {
                                      return IsNear(point, nearest);
                                  }};
        Streamline line = TraceStreamline(_tracer, seed, _options.line, apartness);
        if (line.points.size() < 2 || line.length < shortest) return;
        for (StreamPoint const& point : line.points) _points.Add(point.position, 0);
        _coverage.AddLine(line);
        _lines.push_back(std::move(line));
    }

    /// Lines from both sides of one, every D along it.
    void SeedBeside(size_t line) {
        constexpr double kFarEnough = 0.95;
        double const D = _options.separation;
        double next = 0.0;
        for (size_t i = 0; i < _lines[line].points.size(); ++i) {
            StreamPoint const from = _lines[line].points[i];  // more lines move it
            if (from.length < next) continue;
            next = from.length + D;
            for (Heading const side : {Heading::Left, Heading::Right}) {
                StreamPoint end = from;
                auto const reached = _across.Walk(from.place, side, D, [&](StreamPoint const& p) {
                    end = p;
                    return true;
                });
                if (reached == StreamEnd::Length && !IsNear(end.position, kFarEnough * D))
                    AddLine(end.place, D);
            }
        }
    }

    FlowSurface const& _flow;
    EvenOptions const& _options;
    StreamTracer _tracer, _across;
    Coverage _coverage;
    PointGrid<char> _points;  // of all lines
    std::vector<Streamline> _lines;
};

}  // namespace

EvenLines FillEvenly(FlowSurface const& flow, EvenOptions const& options) {
    Filler filler(flow, options);
    filler.Fill();
    return filler.Finish();
}

EvenLines TraceApart(FlowSurface const& flow, std::span<SurfacePlace const> seeds,
                     EvenOptions const& options) {
    Filler filler(flow, options);
    filler.Trace(seeds);
    return filler.Finish();
}

}  // namespace limn::eval
