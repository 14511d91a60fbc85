// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include <tbb/concurrent_unordered_map.h>

#include "far_ext/rings/ring_subdivision.h"

namespace limn::eval {

/// A ring's subdivision and, found when first asked for, those of its children. Rings repeat: the
/// child at an extraordinary corner soon has the ring of its parent, so that a few nodes stand for
/// every depth of every face.
class RingNode {
public:
    far_ext::RingSubdivision const& Get() const { return _subdivision; }

private:
    friend class RingStore;
    far_ext::RingSubdivision _subdivision;
    std::unique_ptr<std::atomic<RingNode const*>[]> _children;
};

/// Rings of one mesh and channel, each subdivided once. Safe to use from many threads. Nodes live
/// as long as their store.
class RingStore {
public:
    RingStore(Sdc::SchemeType scheme, Sdc::Options options) : _scheme(scheme), _options(options) {}

    RingNode const* Find(far_ext::FaceRing const& ring);
    RingNode const* FindChild(RingNode const& node, int child);

    size_t GetNumRings() const { return _nodes.size(); }
    size_t GetNumBytes() const { return _numBytes; }

private:
    struct Hash {
        size_t operator()(far_ext::FaceRing const& ring) const { return ring.GetHash(); }
    };

    Sdc::SchemeType _scheme;
    Sdc::Options _options;
    tbb::concurrent_unordered_map<far_ext::FaceRing, std::unique_ptr<RingNode>, Hash> _nodes;
    std::atomic<size_t> _numBytes = 0;
};

/// Keeps rings in mind as long as they are few. Where nearly each face has a ring of its own, they
/// would take a hundred times the mesh's memory: a store that is full is left to those who still
/// use it, and another one begins. A subdivision depends on its ring alone, and so not on what is
/// remembered.
class RingCache {
public:
    /// \param mostBytes  that a store may have when another face asks for it
    RingCache(Sdc::SchemeType scheme, Sdc::Options options, size_t mostBytes)
        : _scheme(scheme), _options(options), _mostBytes(mostBytes) {}

    /// Makes `store`, which may be null, one that is not full.
    void Renew(std::shared_ptr<RingStore>& store);

private:
    bool IsFull(RingStore const& store) const { return store.GetNumBytes() > _mostBytes; }

    Sdc::SchemeType _scheme;
    Sdc::Options _options;
    size_t _mostBytes;
    std::mutex _mutex;
    std::shared_ptr<RingStore> _current;
};

}  // namespace limn::eval
