// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/form_wheel.h"

#include <cmath>
#include <numbers>

namespace limn::far_ext {

namespace {

using Chain = std::vector<double>;  // over the wheel's faces, or over its edges

/// The circulant whose rows spread a 2-form over the corners of `count` faces round a vertex:
/// [Forms 3.4] (Loop), [Forms 4] (Doo-Sabin's weights).
///
/// Loop's beta puts the second eigenvalue at 1/2, that of a linear density, for up to 6 faces;
/// beyond, the regular weights stay. Places that coincide where faces are few add up.
std::vector<double> MakeCirculant(Sdc::SchemeType scheme, int count) {
    std::vector<double> c(count, 0.0);
    if (scheme == Sdc::SCHEME_CATMARK) {
        c[0] = (count + 5.0) / (4.0 * count);
        for (int m = 1; m < count; ++m)
            c[m] = (3.0 + 2.0 * std::cos(2.0 * std::numbers::pi * m / count)) / (4.0 * count);
        return c;
    }
    double const beta =
        count >= 6 ? 0.25 : 1.0 / (8.0 * (1.0 - std::cos(2.0 * std::numbers::pi / count)));
    auto const add = [&](int place, double weight) {
        c[((place % count) + count) % count] += weight;
    };
    add(0, 0.75 - beta);
    for (int sign : {-1, 1}) {
        add(sign, 0.125);
        add(2 * sign, 0.5 * beta);
    }
    return c;
}

/// Spokes at which a rule cuts the wheel into fans; none if it is in one piece. A single sharp
/// spoke is a dart: one can walk round it, so nothing is cut [Forms 5].
std::vector<int> FindCuts(Wheel const& wheel, Wheel::Rule const& rule) {
    std::vector<int> cuts;
    int const last = wheel.GetNumSpokes() - 1;
    for (int i = 0; i <= last; ++i) {
        bool const isBorder = !wheel.isInterior && (i == 0 || i == last);
        if (isBorder || rule.isSharp[i]) cuts.push_back(i);
    }
    if (cuts.size() < 2) cuts.clear();
    return cuts;
}

/// Adds one rule's share of s and mu. The products mu D are blended, not mu and D: only so do the
/// columns of s add up to mu where faces differ in it, and the recursion for x closes.
void AddShares(Sdc::SchemeType scheme, Wheel const& wheel, Wheel::Rule const& rule,
               std::vector<Chain>& spread, Chain& mu) {
    int const k = wheel.GetNumFaces();
    bool const isLoop = scheme == Sdc::SCHEME_LOOP;
    auto const add = [&](int row, int column, double rowMu, double weight) {
        double const scale = isLoop ? rowMu : 1.0 / wheel.sizes[column];
        spread[row][column] += rule.share * scale * weight;
    };
    std::vector<int> const cuts = FindCuts(wheel, rule);
    if (cuts.empty()) {
        std::vector<double> const c = MakeCirculant(scheme, k);
        // Less than 1/4 at valence 3, where a swirl would never decay [Forms 6].
        double const rowMu = k == 3 ? 1.0 / 16.0 : 0.25;
        for (int i = 0; i < k; ++i) {
            for (int j = 0; j < k; ++j) add(i, j, rowMu, c[(j - i + k) % k]);
            mu[i] += rule.share * rowMu;
        }
        return;
    }
    size_t const numFans = wheel.isInterior ? cuts.size() : cuts.size() - 1;
    for (size_t fan = 0; fan < numFans; ++fan) {
        int const first = cuts[fan];
        int const size = fan + 1 < cuts.size() ? cuts[fan + 1] - first : cuts[0] + k - first;
        // Reflected in both borders: a fan is half of a wheel with a mirror, so that nothing
        // crosses it and rows and columns still add up to 1 [Forms 3.4].
        std::vector<double> const c = MakeCirculant(scheme, 2 * size);
        double const rowMu = size == 1 && rule.isCrease ? 0.125 : 0.25;
        for (int i = 0; i < size; ++i) {
            int const row = (first + i) % k;
            for (int j = 0; j < size; ++j) {
                add(row, (first + j) % k, rowMu,
                    c[(j - i + 2 * size) % (2 * size)] + c[(i + j + 1) % (2 * size)]);
            }
            mu[row] += rule.share * rowMu;
        }
    }
}

/// Takes out of all x their mean over the spokes where a rule wants none: its cuts, or all spokes.
///
/// The recursion leaves one constant open. On a crease it is spent so that the crease knows its own
/// data only, elsewhere so that no spoke is preferred [Forms 5].
void Centre(Wheel const& wheel, std::vector<Chain>& flow) {
    Chain mean(flow[0].size(), 0.0);
    for (Wheel::Rule const* rule : {&wheel.parent, &wheel.child}) {
        if (rule->share == 0.0) continue;
        std::vector<int> spokes = FindCuts(wheel, *rule);
        if (spokes.empty()) {
            for (int i = 0; i < wheel.GetNumSpokes(); ++i) spokes.push_back(i);
        }
        for (int i : spokes) {
            for (size_t j = 0; j < mean.size(); ++j)
                mean[j] += rule->share * flow[i][j] / static_cast<double>(spokes.size());
        }
    }
    for (Chain& x : flow) {
        for (size_t j = 0; j < mean.size(); ++j) x[j] -= mean[j];
    }
}

/// A 1-chain on the wheel in the making.
class EdgeChain {
public:
    explicit EdgeChain(Wheel const& wheel) : _wheel(wheel) {
        int next = wheel.GetNumSpokes();
        for (int size : wheel.sizes) {
            _firstOuterSides.push_back(next);
            next += size - 2;
        }
        _weights.assign(next, 0.0);
    }

    void AddSpoke(int spoke, double weight) {
        int const count = _wheel.GetNumSpokes();
        _weights[((spoke % count) + count) % count] += weight;
    }

    /// Side m of a face, counter-clockwise from the spoke before it.
    void AddSide(int face, int m, double weight) {
        int const k = _wheel.GetNumFaces();
        face = ((face % k) + k) % k;
        int const size = _wheel.sizes[face];
        if (m == 0)
            AddSpoke(face, weight);
        else if (m == size - 1)
            AddSpoke(face + 1, -weight);
        else
            _weights[_firstOuterSides[face] + m - 1] += weight;
    }

    void AddBoundary(Chain const& faces) {
        for (int face = 0; face < _wheel.GetNumFaces(); ++face) {
            double const weight = faces[face];
            for (int m = 0; weight != 0.0 && m < _wheel.sizes[face]; ++m) AddSide(face, m, weight);
        }
    }

    /// F(e, f) of [Forms 4], from the middle of side `from` to the centroid.
    void AddPathFromMiddle(int face, int from, double weight) {
        int const k = _wheel.GetNumFaces(), size = _wheel.sizes[((face % k) + k) % k];
        for (int j = 1; j < size; ++j)
            AddSide(face, (from + j) % size, weight * (0.5 - static_cast<double>(j) / size));
    }

    /// G(v, f): from the vertex to the centroid.
    void AddPathFromCorner(int face, double weight) {
        int const size = _wheel.sizes[face];
        for (int j = 0; j < size; ++j) AddSide(face, j, weight * (size - 1 - 2 * j) / (2.0 * size));
    }

    WheelRows::Row Get() const { return Compress(_weights); }

    static WheelRows::Row Compress(std::vector<double> const& weights) {
        WheelRows::Row row;
        for (size_t i = 0; i < weights.size(); ++i) {
            if (std::abs(weights[i]) >= 1e-15) row.emplace_back(static_cast<int>(i), weights[i]);
        }
        return row;
    }

private:
    Wheel const& _wheel;
    std::vector<int> _firstOuterSides;  // per face, among the wheel's edges
    std::vector<double> _weights;
};

/// y_i: the curl part of the odd edge that cuts the corner of face i. Columns add up to mu, as
/// those of s do, and regular rows come out as the convolution's [Forms 3.3].
Chain MakeOddCurl(Wheel const& wheel, Chain const& mu, int i) {
    int const k = wheel.GetNumFaces(), spokes = wheel.GetNumSpokes();
    double const before = wheel.faceShares[i], after = wheel.faceShares[(i + 1) % spokes];
    Chain y(k, 0.0);
    y[i] += mu[i] - 0.25 * (before + after);
    if (before != 0.0) y[(i + k - 1) % k] += 0.25 * before;
    if (after != 0.0) y[(i + 1) % k] += 0.25 * after;
    return y;
}

/// Adds S0 of the middle of spoke i, less the part of the vertex itself: p at both neighbours, 1/2
/// - p at w_i.
void AddMiddle(Wheel const& wheel, int i, double sign, EdgeChain& chain) {
    int const spokes = wheel.GetNumSpokes(), spoke = i % spokes;
    double const p = wheel.faceShares[spoke];
    chain.AddSpoke(spoke, sign * (0.5 - p));
    if (p == 0.0) return;
    chain.AddSpoke(spoke - 1, sign * p);
    chain.AddSpoke(spoke + 1, sign * p);
}

/// Star flow of S0[m_i] - S0[v']: what each neighbour has, along its spoke. What v has need not be
/// told, since both rows add up to 1 [Forms 3.2].
EdgeChain MakeLoopEven(Wheel const& wheel, int i) {
    EdgeChain chain(wheel);
    AddMiddle(wheel, i, 1.0, chain);
    for (int j = 0; j < wheel.GetNumSpokes(); ++j) chain.AddSpoke(j, -wheel.edgeWeights[j]);
    return chain;
}

/// The same difference as ways from v: half a spoke, from there to both face points, less the
/// vertex rule's ways to its neighbours and face points [Forms 4].
EdgeChain MakeCatmarkEven(Wheel const& wheel, int i) {
    EdgeChain chain(wheel);
    double const q = wheel.faceShares[i];
    chain.AddSpoke(i, 0.5);
    if (q != 0.0) {
        int const k = wheel.GetNumFaces();
        int const before = (i + k - 1) % k;
        chain.AddPathFromMiddle(i, 0, q);
        chain.AddPathFromMiddle(before, wheel.sizes[before] - 1, q);
    }
    for (int j = 0; j < wheel.GetNumSpokes(); ++j) chain.AddSpoke(j, -wheel.edgeWeights[j]);
    for (int j = 0; wheel.faceWeight != 0.0 && j < wheel.GetNumFaces(); ++j)
        chain.AddPathFromCorner(j, -wheel.faceWeight);
    return chain;
}

}  // namespace

double GetLoopWeight(int k) {
    double const c = 0.375 + 0.25 * std::cos(2.0 * std::numbers::pi / k);
    return k == 6 ? 0.0625 : (0.625 - c * c) / k;
}

Wheel MakeSmoothWheel(Sdc::SchemeType scheme, int k) {
    bool const isLoop = scheme == Sdc::SCHEME_LOOP;
    size_t const count = k;
    Wheel wheel;
    wheel.sizes.assign(count, isLoop ? 3 : 4);
    wheel.faceShares.assign(count, isLoop ? 0.125 : 0.25);
    wheel.edgeWeights.assign(count, isLoop ? GetLoopWeight(k) : 1.0 / (static_cast<double>(k) * k));
    wheel.faceWeight = isLoop ? 0.0 : 1.0 / (static_cast<double>(k) * k);
    wheel.parent = {1.0, std::vector<char>(count, 0), false};
    wheel.child = {0.0, std::vector<char>(count, 0), false};
    return wheel;
}

WheelRows MakeWheelRows(Sdc::SchemeType scheme, Wheel const& wheel) {
    bool const isLoop = scheme == Sdc::SCHEME_LOOP;
    int const numFaces = wheel.GetNumFaces(), numSpokes = wheel.GetNumSpokes();
    size_t const k = numFaces;
    WheelRows rows;
    rows.mu.assign(k, 0.0);
    rows.share.assign(k, Chain(k, 0.0));
    AddShares(scheme, wheel, wheel.parent, rows.share, rows.mu);
    if (wheel.child.share != 0.0) AddShares(scheme, wheel, wheel.child, rows.share, rows.mu);

    // x by x_{i+1} - x_i = y_i - s_i: commutation at each corner child, whose sides are two even
    // edges and what the odd one (Catmull-Clark: the two to the face point) leaves [Forms 2].
    std::vector<Chain> curls;
    rows.flow.assign(1, Chain(k, 0.0));
    for (int i = 0; i < numFaces; ++i) {
        Chain const& s = rows.share[i];
        Chain y(k, 0.0);
        if (isLoop)
            y = MakeOddCurl(wheel, rows.mu, i);
        else
            y[i] = 1.0 / wheel.sizes[i];
        Chain next = rows.flow.back();
        for (size_t j = 0; j < k; ++j) next[j] += y[j] - s[j];
        rows.children.push_back(EdgeChain::Compress(s));
        curls.push_back(std::move(y));
        if (i + 1 < numSpokes) rows.flow.push_back(std::move(next));
    }
    if (wheel.isInterior)
        Centre(wheel, rows.flow);
    else
        rows.flow.back().assign(k, 0.0);  // which it is, but for rounding

    for (int i = 0; i < numSpokes; ++i) {
        EdgeChain chain = isLoop ? MakeLoopEven(wheel, i) : MakeCatmarkEven(wheel, i);
        chain.AddBoundary(rows.flow[i]);
        rows.even.push_back(chain.Get());
    }
    for (int i = 0; isLoop && i < numFaces; ++i) {
        EdgeChain chain(wheel);
        AddMiddle(wheel, i + 1, 1.0, chain);
        AddMiddle(wheel, i, -1.0, chain);
        chain.AddBoundary(curls[i]);
        rows.odd.push_back(chain.Get());
    }
    return rows;
}

}  // namespace limn::far_ext
