// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/ring_cache.h"

namespace limn::eval {

RingNode const* RingStore::Find(far_ext::FaceRing const& ring) {
    auto const known = _nodes.find(ring);
    if (known != _nodes.end()) return known->second.get();
    // A thread that builds the same ring meanwhile makes the same numbers.
    auto node = std::make_unique<RingNode>();
    node->_subdivision = far_ext::RingSubdivision::Build(ring, _scheme, _options);
    size_t const numChildren = node->_subdivision.children.size();
    node->_children = std::make_unique<std::atomic<RingNode const*>[]>(numChildren);
    auto const [found, isNew] = _nodes.emplace(ring, std::move(node));
    if (isNew) _numBytes += ring.GetNumBytes() + found->second->_subdivision.GetNumBytes();
    return found->second.get();
}

RingNode const* RingStore::FindChild(RingNode const& node, int child) {
    RingNode const* found = node._children[child].load(std::memory_order_acquire);
    if (!found) {
        found = Find(node._subdivision.children[child].ring);
        node._children[child].store(found, std::memory_order_release);
    }
    return found;
}

void RingCache::Renew(std::shared_ptr<RingStore>& store) {
    if (store && !IsFull(*store)) return;
    std::lock_guard const lock(_mutex);
    if (!_current || IsFull(*_current)) _current = std::make_shared<RingStore>(_scheme, _options);
    store = _current;
}

}  // namespace limn::eval
