// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/ring_cache.h"

namespace limn::eval {

RingNode const* RingCache::Find(far_ext::FaceRing const& ring) {
    {
        std::lock_guard const lock(_mutex);
        auto const found = _nodes.find(ring);
        if (found != _nodes.end()) return found->second.get();
    }
    // Built outside the lock; a thread that builds the same ring meanwhile makes the same numbers.
    auto node = std::make_unique<RingNode>();
    node->_subdivision = far_ext::RingSubdivision::Build(ring, _scheme, _options);
    size_t const numChildren = node->_subdivision.children.size();
    node->_children = std::make_unique<std::atomic<RingNode const*>[]>(numChildren);
    std::lock_guard const lock(_mutex);
    return _nodes.try_emplace(ring, std::move(node)).first->second.get();
}

RingNode const* RingCache::FindChild(RingNode const& node, int child) {
    RingNode const* found = node._children[child].load(std::memory_order_acquire);
    if (!found) {
        found = Find(node._subdivision.children[child].ring);
        node._children[child].store(found, std::memory_order_release);
    }
    return found;
}

}  // namespace limn::eval
