// Types of the broad and the narrow phase: surfaces, triangles and pairs of triangles, in one global numbering.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "core/types.hpp"

namespace weft::collision {

/// Three vertices of the global vertex array, counter-clockwise seen from the front. A piece of rope from a to b is the
/// degenerate triangle (a, b, b): one edge and its two ends.
using Triangle = std::array<Index, 3>;

/// A cloth, rope, rigid body or obstacle: a range of the global vertex array and the triangles between these vertices.
struct Surface {
  std::span<const Triangle> triangles;  ///< corners are global vertex indices inside the range below
  Index first_triangle = 0;             ///< global number of triangles.front()
  Index first_vertex = 0;
  Index vertex_count = 0;
};

/// Two triangles by their global numbers; a < b if both belong to one surface.
struct TrianglePair {
  Index a, b;
  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// A list of pairs that keeps its memory when cleared. Callers reserve space for several pairs at
/// once, so the capacity is not checked for every pair. Reserved memory is not initialised, so the
/// system need not provide unused pages.
class PairList {
 public:
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::span<const TrianglePair> view() const { return {storage_.get(), size_}; }
  const TrianglePair* begin() const { return storage_.get(); }
  const TrianglePair* end() const { return storage_.get() + size_; }

  /// Reserves space for `count` more pairs. Write the pairs to the returned address, then call
  /// grow() with the address after the last one.
  TrianglePair* reserve_more(std::size_t count) {
    if (size_ + count > capacity_) {
      capacity_ = size_ + count + (size_ + count) / 2;
      auto larger = std::make_unique_for_overwrite<TrianglePair[]>(capacity_);
      std::ranges::copy(*this, larger.get());
      storage_ = std::move(larger);
    }
    return storage_.get() + size_;
  }
  void append(std::span<const TrianglePair> more) {
    grow(std::copy(more.begin(), more.end(), reserve_more(more.size())));
  }
  void grow(const TrianglePair* end) { size_ = static_cast<std::size_t>(end - storage_.get()); }

 private:
  std::unique_ptr<TrianglePair[]> storage_;
  std::size_t size_ = 0, capacity_ = 0;
};

/// Pairs of triangles whose bounds overlap. Pairs with two or three common vertices are in neither list.
struct CandidatePairs {
  PairList apart;       ///< pairs without a common vertex
  PairList one_shared;  ///< pairs with exactly one common vertex

  void clear() {
    apart.clear();
    one_shared.clear();
  }
  friend void append(CandidatePairs& to, const CandidatePairs& more) {
    to.apart.append(more.apart.view());
    to.one_shared.append(more.one_shared.view());
  }
};

}  // namespace weft::collision
