#include "physics/collision/bodies.hpp"

#include <algorithm>

#include "physics/collision/proximity/features.hpp"

namespace weft::collision {

void Bodies::add(std::span<const std::array<Index, 3>> triangles, Index vertex_count, const BodyTraits& traits,
                 std::span<const Patch> patches, std::span<const Index> limbs, Index in_front) {
  const auto first_triangle = static_cast<Index>(triangles_.size()), first_vertex = static_cast<Index>(body_of_.size());
  vertex_count += in_front;
  triangles_.reserve(triangles_.size() + triangles.size());
  for (Triangle t : triangles) {
    for (Index& corner : t) corner += first_vertex + in_front;
    triangles_.push_back(t);
  }
  body_of_.insert(body_of_.end(), vertex_count, traits_.size());
  if (limbs.empty())
    limb_of_.insert(limb_of_.end(), vertex_count, 0);
  else
    limb_of_.insert(limb_of_.end(), limbs.begin(), limbs.end());
  material_of_.insert(material_of_.end(), vertex_count, materials_.size());
  materials_.push_back({traits_.size(), traits.thickness, traits.friction});
  for (const Patch& patch : patches) {
    for (std::size_t v = 0; v < patch.vertices.size(); ++v)
      if (patch.vertices[v] != 0) material_of_[static_cast<std::size_t>(first_vertex) + v] = materials_.size();
    materials_.push_back({traits_.size(), patch.thickness, patch.friction});
  }
  traits_.push_back(traits);
  self_colliding_count_ += traits.deformable && !traits.rigid ? 1 : 0;
  surfaces_.push_back({{}, first_triangle, first_vertex, vertex_count});
  // Renew the spans: reserve() may have moved the triangles.
  for (std::size_t b = 0; b < surfaces_.size(); ++b) {
    const std::size_t begin = surfaces_[b].first_triangle,
                      end = b + 1 < surfaces_.size() ? surfaces_[b + 1].first_triangle : triangles_.size();
    surfaces_[b].triangles = std::span(triangles_).subspan(begin, end - begin);
  }
}

Index Bodies::triangle_of(const Triangle& corners) const {
  const std::span<const Triangle> triangles = surfaces_[body_of(corners[0])].triangles;
  const auto has_all = [&](const Triangle& t) {
    return std::ranges::all_of(corners, [&](Index v) { return has_vertex(t, v); });
  };
  return static_cast<Index>(std::ranges::find_if(triangles, has_all) - triangles.begin());
}

}  // namespace weft::collision
