// The box, plain or with rounded edges and corners.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "physics/mesh/quads.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::mesh {
namespace {

/// Largest bevel, relative to the smallest edge length. At 0.5, flat sides would have no area left.
constexpr double kMaxBevel = 0.49;

/// A box is the hull of eight octants of a small sphere. Each octant is a triangular lattice of points (i, j, k) with i
/// + j + k = steps; (steps, 0, 0) lies on the side of the box perpendicular to the x axis, and so on. Strips along the
/// edges and the six flat sides join neighbouring octants. steps = 0 means sharp corners: one point each.
class RoundedBox {
 public:
  RoundedBox(const Vec3& size, double bevel, int steps) : steps_(steps) {
    const Vec3 inner = 0.5 * size - Vec3::Constant(bevel);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j)
          mesh_.positions.push_back(sign.cwiseProduct(inner + bevel * direction(i, j, steps - i - j)));
    }
    for (int corner = 0; corner < 8; ++corner) add_octant(corner);
    for (int axis = 0; axis < 3; ++axis) {
      add_edges(axis);
      add_sides(axis);
    }
  }

  Mesh take() { return std::move(mesh_); }

 private:
  using Lattice = std::array<int, 3>;

  /// Unit direction of a lattice point: equal angles along the rim of the octant, where one of i, j, k is zero.
  Vec3 direction(int i, int j, int k) const {
    if (steps_ == 0) return Vec3::Zero();
    const double quarter = 0.5 * std::numbers::pi / steps_;
    return Vec3(std::sin(i * quarter), std::sin(j * quarter), std::sin(k * quarter)).normalized();
  }

  Index vertex(int corner, const Lattice& p) const {
    const int octant = (steps_ + 1) * (steps_ + 2) / 2;
    // The rows before row p[0] have steps + 1, steps, steps − 1, … points.
    const int before = p[0] * (steps_ + 1) - p[0] * (p[0] - 1) / 2;
    return corner * octant + before + p[1];
  }

  void add(Quad q, bool reversed) {
    if (reversed) std::reverse(q.begin(), q.end());
    for (const Triangle& t : split_quad(q, true)) mesh_.topology.triangles.push_back(t);
  }

  /// Whether the corner has an odd number of negative signs: faces given for the corner (+, +, +) then run clockwise.
  static bool is_mirrored(int corner) { return ((corner & 1) + (corner >> 1 & 1) + (corner >> 2)) % 2 == 0; }

  void add_octant(int corner) {
    const auto add_triangle = [&](const Lattice& a, const Lattice& b, const Lattice& c) {
      Triangle t{vertex(corner, a), vertex(corner, b), vertex(corner, c)};
      if (is_mirrored(corner)) std::swap(t[1], t[2]);
      mesh_.topology.triangles.push_back(t);
    };
    for (int i = 0; i < steps_; ++i) {
      for (int j = 0; i + j < steps_; ++j) {
        const int k = steps_ - i - j;
        add_triangle({i, j, k}, {i + 1, j, k - 1}, {i, j + 1, k - 1});
        if (k >= 2) add_triangle({i + 1, j, k - 1}, {i + 1, j + 1, k - 2}, {i, j + 1, k - 1});
      }
    }
  }

  /// Lattice point with `first` on axis + 1 (modulo 3) and the remainder on axis + 2.
  Lattice rim(int axis, int first) const {
    Lattice p{};
    p[(axis + 1) % 3] = first;
    p[(axis + 2) % 3] = steps_ - first;
    return p;
  }

  /// The four rounded edges parallel to an axis.
  void add_edges(int axis) {
    for (int corner = 0; corner < 8; ++corner) {
      if (corner >> axis & 1) continue;
      const int other = corner | 1 << axis;
      for (int s = 0; s < steps_; ++s) {
        const Lattice a = rim(axis, s), b = rim(axis, s + 1);
        add({vertex(corner, a), vertex(other, a), vertex(other, b), vertex(corner, b)}, !is_mirrored(corner));
      }
    }
  }

  /// The two flat sides perpendicular to an axis.
  void add_sides(int axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    Lattice p{};
    p[axis] = steps_;
    for (const int side : {0, 1 << axis})
      add({vertex(side, p), vertex(side | u, p), vertex(side | u | v, p), vertex(side | v, p)}, side == 0);
  }

  int steps_;
  Mesh mesh_;
};

}  // namespace

Mesh make_box(const Vec3& size, double bevel, int segments) {
  bevel = std::clamp(bevel, 0.0, kMaxBevel * size.minCoeff());
  return RoundedBox(size, bevel, bevel > 0 ? std::max(1, segments / 8) : 0).take();
}

}  // namespace weft::mesh
