#include "render/in_view.hpp"

#include <cstdint>

namespace weft::render {
namespace {

using Clip = Eigen::Vector4d;

// Signed distance to the sides of the picture and the near plane; negative outside.
constexpr int kSides = 5;
double side_distance(const Clip& at, int side) {
  if (side == 4) return at.w() + at.z();
  const double along = at[side / 2];
  return at.w() + (side % 2 == 0 ? along : -along);
}

/// Outcode: one bit for each side that a point is beyond.
std::uint8_t outcode_of(const Clip& at) {
  std::uint8_t code = 0;
  for (int side = 0; side < kSides; ++side)
    code |= static_cast<std::uint8_t>((side_distance(at, side) < 0 ? 1 : 0) << side);
  return code;
}

struct Corner {
  Vec3 place;
  Clip clip;
};

/// Clips a triangle at the sides of the picture (Sutherland and Hodgman 1974).
void cut(std::vector<Corner> corners, InView& in_view) {
  for (int side = 0; side < kSides; ++side) {
    std::vector<Corner> left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Corner &from = corners[i], &to = corners[(i + 1) % corners.size()];
      const double there = side_distance(from.clip, side), next = side_distance(to.clip, side);
      if (there >= 0) left.push_back(from);
      if ((there >= 0) == (next >= 0)) continue;
      const double share = there / (there - next);
      left.push_back({from.place + share * (to.place - from.place), from.clip + share * (to.clip - from.clip)});
    }
    corners = std::move(left);
  }
  for (std::size_t i = 2; i < corners.size(); ++i)
    in_view.cut.push_back({corners[0].place, corners[i - 1].place, corners[i].place});
}

}  // namespace

std::optional<InView> parts_in_view(const View& view, std::span<const DrawnMesh> meshes,
                                    const std::optional<Floor>& floor) {
  InView in_view;
  bool all = true;
  std::vector<std::uint8_t> codes;
  const auto corner = [&](const Vec3& place) { return Corner{place, view.clip_from_world * place.homogeneous()}; };
  for (const DrawnMesh& mesh : meshes) {
    codes.clear();
    for (const Vec3& place : mesh.positions) {
      codes.push_back(outcode_of(view.clip_from_world * place.homogeneous()));
      if (codes.back() == 0) in_view.places.push_back(place);
      all = all && codes.back() == 0;
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      if ((codes[a] | codes[b] | codes[c]) == 0 || (codes[a] & codes[b] & codes[c]) != 0) continue;
      cut({corner(mesh.positions[a]), corner(mesh.positions[b]), corner(mesh.positions[c])}, in_view);
    }
  }
  if (all) return std::nullopt;
  if (floor) {
    // Floor as far as the picture shows it.
    const Vec3 under = view.eye - floor->normal.dot(view.eye - floor->point) * floor->normal;
    const Vec3 x = view.far * floor->normal.unitOrthogonal(), y = floor->normal.cross(x);
    cut({corner(under + x + y), corner(under - x + y), corner(under - x - y)}, in_view);
    cut({corner(under + x + y), corner(under - x - y), corner(under + x - y)}, in_view);
  }
  return in_view;
}

}  // namespace weft::render
