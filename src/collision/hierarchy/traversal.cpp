#include "collision/hierarchy/traversal.hpp"

#include "collision/hierarchy/walk.hpp"

namespace weft::collision {

namespace {

template <int K, int Arity>
void walk(const Tree<K, Arity>& a, const Tree<K, Arity>& b, CandidatePairs& out, const Traversal& how) {
  if (a.empty() || b.empty()) return;
  if (how.open_longer_side)
    how.list != nullptr ? Walk<K, Arity, true, true>(a, b, how, out).run()
                        : Walk<K, Arity, true, false>(a, b, how, out).run();
  else
    how.list != nullptr ? Walk<K, Arity, false, true>(a, b, how, out).run()
                        : Walk<K, Arity, false, false>(a, b, how, out).run();
}

}  // namespace

template <int K, int Arity>
void self_pairs(const Tree<K, Arity>& tree, CandidatePairs& out, const Traversal& how) {
  walk(tree, tree, out, how);
}

template <int K, int Arity>
void pairs(const Tree<K, Arity>& tree_a, const Tree<K, Arity>& tree_b, CandidatePairs& out, const Traversal& how) {
  walk(tree_a, tree_b, out, how);
}

#define WEFT_INSTANTIATE(K, Arity)                                                    \
  template void self_pairs(const Tree<K, Arity>&, CandidatePairs&, const Traversal&); \
  template void pairs(const Tree<K, Arity>&, const Tree<K, Arity>&, CandidatePairs&, const Traversal&);
WEFT_INSTANTIATE(6, 2)
WEFT_INSTANTIATE(6, 4)
WEFT_INSTANTIATE(6, 8)
WEFT_INSTANTIATE(14, 2)
WEFT_INSTANTIATE(14, 4)
WEFT_INSTANTIATE(14, 8)
WEFT_INSTANTIATE(18, 2)
WEFT_INSTANTIATE(18, 4)
WEFT_INSTANTIATE(18, 8)
WEFT_INSTANTIATE(26, 2)
WEFT_INSTANTIATE(26, 4)
WEFT_INSTANTIATE(26, 8)
#undef WEFT_INSTANTIATE

}  // namespace weft::collision
