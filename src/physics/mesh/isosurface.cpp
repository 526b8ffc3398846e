#include "physics/mesh/isosurface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {
namespace {

/// Values of the field at the nodes of a cubic lattice that starts at x = 0. Each value is
/// evaluated on first use and cached.
class Lattice {
 public:
  Lattice(const Field& field, const Box3& box, double cell) : field_(field), cell_(cell) {
    for (int k = 0; k < 3; ++k) {
      const double low = k == 0 ? 0.0 : box.min()[k];
      origin_[k] = low;
      // Round up to whole blocks.
      const int cells = static_cast<int>(std::ceil((box.max()[k] - low) / cell));
      nodes_[k] = (cells + kBlock - 1) / kBlock * kBlock + 1;
    }
    values_.assign(static_cast<std::size_t>(nodes_[0]) * nodes_[1] * nodes_[2], std::nan(""));
  }

  static constexpr int kBlock = 4;  ///< number of cells along each side of a block; even

  int nodes(int axis) const { return nodes_[axis]; }
  std::int64_t index(int i, int j, int k) const {
    return i + nodes_[0] * (j + static_cast<std::int64_t>(nodes_[1]) * k);
  }
  Vec3 place(int i, int j, int k) const { return origin_ + cell_ * Vec3(i, j, k); }

  double value(int i, int j, int k) {
    double& v = values_[index(i, j, k)];
    if (std::isnan(v)) v = field_(place(i, j, k));
    return v;
  }

  /// Whether the zero set may pass through the block whose lowest node is (i, j, k). False if |field| at the centre of
  /// the block, which is a node, is so large that a field with a gradient below 3 (see Field) has no zero in the block.
  bool may_cross(int i, int j, int k) {
    constexpr int half = kBlock / 2;
    const double half_diagonal = std::sqrt(3.0) / 2 * kBlock * cell_;
    return std::abs(value(i + half, j + half, k + half)) < 3 * half_diagonal;
  }

 private:
  const Field& field_;
  double cell_;
  Vec3 origin_ = Vec3::Zero();
  std::array<int, 3> nodes_{};
  std::vector<double> values_;
};

struct Node {
  std::array<int, 3> at{};
  std::int64_t index = 0;
  double value = 0;
};

/// Cuts tetrahedra along the zero set and collects the triangles. Each edge of a tetrahedron that
/// crosses the zero set gets one vertex, which all tetrahedra at this edge share.
class Cutter {
 public:
  explicit Cutter(const Lattice& lattice) : lattice_(lattice) {}

  /// The determinant of the edges from corner 0 to corners 1, 2 and 3 must be positive.
  void cut(const std::array<Node, 4>& corner) {
    std::array<int, 4> in{}, out{};
    int ins = 0, outs = 0;
    for (int c = 0; c < 4; ++c) {
      if (corner[c].value < 0) {
        in[ins++] = c;
      } else {
        out[outs++] = c;
      }
    }
    if (ins == 0 || outs == 0) return;
    const auto v = [&](int a, int b) { return vertex(corner[a], corner[b]); };
    // The inside corners followed by the outside corners, each in ascending order, are a permutation of 0 1 2 3. If the
    // permutation is odd, the triangles are reversed.
    if (ins == 1) {
      add(v(in[0], out[0]), v(in[0], out[1]), v(in[0], out[2]), in[0] % 2 != 0);
    } else if (outs == 1) {
      add(v(out[0], in[0]), v(out[0], in[1]), v(out[0], in[2]), out[0] % 2 == 0);
    } else {
      const bool odd = in[0] + in[1] == 2 || in[0] + in[1] == 4;  // {0, 2} or {1, 3} inside
      const Index a = v(in[0], out[0]), b = v(in[0], out[1]), c = v(in[1], out[1]), d = v(in[1], out[0]);
      add(a, b, c, odd);
      add(a, c, d, odd);
    }
  }

  Mesh mesh;

 private:
  Index vertex(const Node& a, const Node& b) {
    const auto [low, high] = std::minmax(a.index, b.index);
    // Node indices fit into 32 bits: the values of 2³² nodes would take 32 GiB.
    const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
    const auto [entry, is_new] = vertices_.try_emplace(key, static_cast<Index>(mesh.positions.size()));
    if (is_new) {
      const Node& first = a.index == low ? a : b;
      const Node& second = a.index == low ? b : a;
      // Keep the vertex away from the nodes, so that each triangle has an area.
      const double s = std::clamp(first.value / (first.value - second.value), 0.05, 0.95);
      const Vec3 p = lattice_.place(first.at[0], first.at[1], first.at[2]);
      const Vec3 q = lattice_.place(second.at[0], second.at[1], second.at[2]);
      mesh.positions.push_back((1 - s) * p + s * q);
    }
    return entry->second;
  }

  void add(Index a, Index b, Index c, bool reversed) {
    if (reversed) std::swap(b, c);
    mesh.topology.triangles.push_back({a, b, c});
  }

  const Lattice& lattice_;
  std::unordered_map<std::uint64_t, Index> vertices_;
};

/// The six tetrahedra of a cube. The corners of a tetrahedron are the corners of the cube on a path
/// of three cube edges from one end of the diagonal to the other. Each entry is the order of the
/// axes along such a path.
constexpr std::array<std::array<int, 3>, 6> kOrders{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

void cut_cell(Lattice& lattice, Cutter& cutter, int i, int j, int k) {
  const auto node = [&](std::array<int, 3> at) {
    return Node{at, lattice.index(at[0], at[1], at[2]), lattice.value(at[0], at[1], at[2])};
  };
  bool inside = false, outside = false;
  for (int c = 0; c < 8; ++c) {
    const double value = lattice.value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
    (value < 0 ? inside : outside) = true;
  }
  if (!inside || !outside) return;
  for (std::size_t o = 0; o < kOrders.size(); ++o) {
    std::array<int, 3> at{i, j, k};
    std::array<Node, 4> corner{node(at)};
    for (std::size_t step = 0; step < 3; ++step) {
      ++at[kOrders[o][step]];
      corner[step + 1] = node(at);
    }
    if (o >= 3) std::swap(corner[1], corner[2]);  // the last three orders are odd permutations
    cutter.cut(corner);
  }
}

}  // namespace

Mesh march_half_space(const Field& field, const Box3& box, double cell) {
  Lattice lattice(field, box, cell);
  Cutter cutter(lattice);
  constexpr int block = Lattice::kBlock;
  for (int k = 0; k + 1 < lattice.nodes(2); k += block) {
    for (int j = 0; j + 1 < lattice.nodes(1); j += block) {
      for (int i = 0; i + 1 < lattice.nodes(0); i += block) {
        if (!lattice.may_cross(i, j, k)) continue;
        for (int c = 0; c < block * block * block; ++c) {
          cut_cell(lattice, cutter, i + c % block, j + c / block % block, k + c / (block * block));
        }
      }
    }
  }
  return std::move(cutter.mesh);
}

MirroredMesh join_mirror_image(const Mesh& half) {
  const std::size_t count = half.positions.size();
  std::vector<bool> on_border(count, false);
  for (const Edge& edge : collect_edges(half.topology.triangles).edges) {
    if (edge.triangles[1] < 0) {
      for (const Index v : edge.vertices) on_border[v] = true;
    }
  }
  MirroredMesh joined;
  std::vector<Index> place(count), image(count);
  for (std::size_t v = 0; v < count; ++v) {
    if (!on_border[v]) continue;
    place[v] = image[v] = static_cast<Index>(joined.mesh.positions.size());
    joined.mesh.positions.push_back(half.positions[v]);
    joined.image.push_back(place[v]);
  }
  const std::size_t off_border = count - joined.mesh.positions.size();
  for (std::size_t v = 0; v < count; ++v) {
    if (on_border[v]) continue;
    place[v] = static_cast<Index>(joined.mesh.positions.size());
    image[v] = place[v] + static_cast<Index>(off_border);
    joined.mesh.positions.push_back(half.positions[v]);
    joined.image.push_back(image[v]);
  }
  for (std::size_t v = 0; v < count; ++v) {
    if (on_border[v]) continue;
    joined.mesh.positions.push_back(half.positions[v].cwiseProduct(Vec3(-1, 1, 1)));
    joined.image.push_back(place[v]);
  }
  auto& triangles = joined.mesh.topology.triangles;
  for (const Triangle& t : half.topology.triangles) triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  for (const Triangle& t : half.topology.triangles) triangles.push_back({image[t[0]], image[t[2]], image[t[1]]});
  return joined;
}

}  // namespace weft::mesh
