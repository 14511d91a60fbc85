// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "far_ext/rings/ring_subdivision.h"

namespace limn::eval {

/// A ring's subdivision and, found when first asked for, those of its children. Rings repeat: the
/// child at an extraordinary corner soon has the ring of its parent, so that a few nodes stand for
/// every depth of every face.
class RingNode {
public:
    far_ext::RingSubdivision const& Get() const { return _subdivision; }

private:
    friend class RingCache;
    far_ext::RingSubdivision _subdivision;
    std::unique_ptr<std::atomic<RingNode const*>[]> _children;
};

/// All rings of one mesh and channel, each subdivided once. Safe to use from many threads.
class RingCache {
public:
    RingCache(Sdc::SchemeType scheme, Sdc::Options options) : _scheme(scheme), _options(options) {}

    RingNode const* Find(far_ext::FaceRing const& ring);
    RingNode const* FindChild(RingNode const& node, int child);

private:
    struct Hash {
        size_t operator()(far_ext::FaceRing const& ring) const { return ring.Hash(); }
    };

    Sdc::SchemeType _scheme;
    Sdc::Options _options;
    std::mutex _mutex;
    std::unordered_map<far_ext::FaceRing, std::unique_ptr<RingNode>, Hash> _nodes;
};

}  // namespace limn::eval
