#include "physics/collision/hierarchy/traversal.hpp"

#include "physics/collision/hierarchy/traverser.hpp"

namespace weft::collision {

namespace {

template <int K>
void walk(const Tree<K>& a, const Tree<K>& b, CandidatePairs& out, const Traversal& how) {
  if (a.empty() || b.empty()) return;
  if (how.open_longer_side)
    how.list != nullptr ? Traverser<K, true, true>(a, b, how, out).run()
                        : Traverser<K, true, false>(a, b, how, out).run();
  else
    how.list != nullptr ? Traverser<K, false, true>(a, b, how, out).run()
                        : Traverser<K, false, false>(a, b, how, out).run();
}

}  // namespace

template <int K>
void self_pairs(const Tree<K>& tree, CandidatePairs& out, const Traversal& how) {
  walk(tree, tree, out, how);
}

template <int K>
void pairs(const Tree<K>& tree_a, const Tree<K>& tree_b, CandidatePairs& out, const Traversal& how) {
  walk(tree_a, tree_b, out, how);
}

#define WEFT_INSTANTIATE(K)                                                    \
  template void self_pairs(const Tree<K>&, CandidatePairs&, const Traversal&); \
  template void pairs(const Tree<K>&, const Tree<K>&, CandidatePairs&, const Traversal&);
WEFT_INSTANTIATE(6)
WEFT_INSTANTIATE(18)
WEFT_INSTANTIATE(26)
#undef WEFT_INSTANTIATE

}  // namespace weft::collision
