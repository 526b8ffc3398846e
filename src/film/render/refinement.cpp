#include "film/render/refinement.hpp"

#include <algorithm>
#include <unordered_map>

namespace weft::render {
void Refinement::update(std::span<const Triangle> coarse, std::size_t vertices) {
  if (std::ranges::equal(coarse, coarse_)) return;
  coarse_.assign(coarse.begin(), coarse.end());
  edges_.clear();
  triangles_.clear();
  std::unordered_map<std::uint64_t, Index> known;
  const auto middle_of = [&](Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [entry, added] =
        known.try_emplace(static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high),
                          static_cast<Index>(vertices + edges_.size()));
    if (added) edges_.push_back({low, high});
    return entry->second;
  };
  for (const auto& [a, b, c] : coarse_) {
    const Index ab = middle_of(a, b), bc = middle_of(b, c), ca = middle_of(c, a);
    triangles_.insert(triangles_.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
}

Middle middle(const Vec3& a, const Vec3& b, const Vec3& normal_a, const Vec3& normal_b, double max_offset) {
  const Vec3 along = b - a, sum = normal_a + normal_b;
  Vec3 off = along.dot(normal_b) * normal_b - along.dot(normal_a) * normal_a;
  off *= 0.125;
  if (off.norm() > max_offset) off *= max_offset / off.norm();
  const Vec3 normal = sum.squaredNorm() > 1e-6 ? Vec3(sum.normalized()) : normal_a;
  return {0.5 * (a + b) + off, normal};
}

}  // namespace weft::render
