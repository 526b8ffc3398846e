#include "tools/export/normals.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/disjoint_sets.hpp"

namespace weft::exporter {
namespace {

// Normal of a triangle; its length is twice the area.
Vec3 front_of(const std::array<Index, 3>& t, const std::vector<Vec3>& x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[static_cast<std::size_t>(t[k])]; };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

Index index(std::size_t i) {
  return static_cast<Index>(i);
}

}  // namespace

NormalGroups group_normals(const frame::Surface& surface, const std::vector<Vec3>& positions) {
  const auto& triangles = surface.triangles;
  NormalGroups groups;
  if (surface.crease_angle >= 180) {
    groups.of_corner = triangles;
    groups.vertex_of.resize(positions.size());
    std::iota(groups.vertex_of.begin(), groups.vertex_of.end(), 0);
    return groups;
  }
  // For each smooth edge, joins the corners of both triangles at each end of the edge. A corner is 3 × triangle + k.
  DisjointSets corners(3 * triangles.size());
  const double min_cosine = std::cos(surface.crease_angle * std::numbers::pi / 180);
  std::map<std::pair<Index, Index>, std::size_t> edges;  // by directed edge: the corner at its start
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) edges[{triangles[t][k], triangles[t][(k + 1) % 3]}] = 3 * t + k;
  for (const auto& [edge, corner] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    if (other == edges.end()) continue;
    const std::size_t t = corner / 3, u = other->second / 3;
    const Vec3 a = front_of(triangles[t], positions), b = front_of(triangles[u], positions);
    if (a.dot(b) < min_cosine * a.norm() * b.norm()) continue;
    corners.join(index(corner), index(3 * u + (other->second + 1) % 3));
    corners.join(index(3 * t + (corner + 1) % 3), index(other->second));
  }
  std::map<Index, Index> numbers;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    auto& of_triangle = groups.of_corner.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [group, fresh] =
          numbers.try_emplace(corners.root(index(3 * t + k)), static_cast<Index>(groups.vertex_of.size()));
      if (fresh) groups.vertex_of.push_back(triangles[t][k]);
      of_triangle[k] = group->second;
    }
  }
  return groups;
}

std::vector<Vec3> normals_of(const NormalGroups& groups, const frame::Surface& surface,
                             const std::vector<Vec3>& positions) {
  std::vector<Vec3> normals(groups.vertex_of.size(), Vec3::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Vec3 front = front_of(surface.triangles[t], positions);
    for (const Index group : groups.of_corner[t]) normals[static_cast<std::size_t>(group)] += front;
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    normal = length > 0 ? Vec3(normal / length) : Vec3(0, 0, 1);
  }
  return normals;
}

}  // namespace weft::exporter
