#include "physics/collision/variants/normal_cones.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace weft::collision {

bool is_star_shaped(std::span<const std::array<Index, 2>> contour, const Vec3& axis, std::span<const Vec3> x_t0,
                    std::span<const Vec3> x_t1) {
  Vec3 centre_t0 = Vec3::Zero(), centre_t1 = Vec3::Zero();
  for (const auto& edge : contour) {
    centre_t0 += x_t0[edge[0]];
    centre_t1 += x_t1[edge[0]];
  }
  centre_t0 /= static_cast<double>(contour.size());
  centre_t1 /= static_cast<double>(contour.size());

  // All edges turn counter-clockwise, so the number of turns is the number of edges that cross the line up · p = 0
  // upwards.
  const Vec3 up = axis.unitOrthogonal();
  int turns = 0;
  for (const auto& edge : contour) {
    const Vec3 p0 = x_t0[edge[0]] - centre_t0, q0 = x_t0[edge[1]] - centre_t0;
    const Vec3 p1 = x_t1[edge[0]] - centre_t1, q1 = x_t1[edge[1]] - centre_t1;
    const double least =
        std::min({axis.dot(p0.cross(q0)), 0.5 * axis.dot(p0.cross(q1) + p1.cross(q0)), axis.dot(p1.cross(q1))});
    const double size = std::max(p0.squaredNorm(), p1.squaredNorm()) + std::max(q0.squaredNorm(), q1.squaredNorm());
    if (!(least > kRoundoff * size)) return false;
    turns += static_cast<int>(up.dot(p0) < 0 && up.dot(q0) >= 0);
  }
  return turns == 1;
}

/// Fills Subtree for each node and leaf.
template <int K>
class NormalCones<K>::Builder {
 public:
  Builder(const Tree<K>& tree, std::vector<Subtree>& subtrees) : tree_(tree), subtrees_(subtrees) {
    const Surface& surface = tree.surface();
    const auto vertices = static_cast<std::size_t>(surface.vertex_count);
    around_.resize(vertices);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (const Index v : surface.triangles[t]) around_[local(v)].push_back(static_cast<Index>(t));
    leaf_of_.resize(surface.triangles.size());
    for (std::size_t n = 0; n < tree.leaves().size(); ++n)
      for (int l = 0; l < tree.leaves()[n].count; ++l)
        leaf_of_[tree.leaves()[n].triangle[l] - surface.first_triangle] = n;
    find_border();
  }

  /// Fills Subtree for `ref` and all nodes and leaves below it. Returns the triangles below `ref`.
  std::vector<Index> build(Ref ref) {
    std::vector<Index> below;
    if (ref < 0) {
      const auto& leaf = tree_.leaves()[~ref];
      for (int l = 0; l < leaf.count; ++l) below.push_back(leaf.triangle[l] - tree_.surface().first_triangle);
    } else {
      const auto& node = tree_.nodes()[ref];
      for (int i = 0; i < node.count; ++i) {
        const std::vector<Index> part = build(node.child[i]);
        below.insert(below.end(), part.begin(), part.end());
      }
    }
    fill_subtree(ref, below);
    return below;
  }

 private:
  using Edge = std::array<Index, 2>;
  struct EdgeHash {
    std::size_t operator()(const Edge& e) const {
      return static_cast<std::size_t>(e[0]) * 0x9E3779B97F4A7C15U + static_cast<std::size_t>(e[1]);
    }
  };

  std::size_t local(Index v) const { return static_cast<std::size_t>(v - tree_.surface().first_vertex); }
  const Triangle& triangle(Index t) const { return tree_.surface().triangles[t]; }

  /// Marks the border of the surface: vertices at an edge that does not have exactly one triangle on each side.
  void find_border() {
    std::unordered_set<Edge, EdgeHash> all;
    border_.assign(around_.size(), 0);
    const auto mark = [&](const Edge& e) { border_[local(e[0])] = border_[local(e[1])] = 1; };
    const auto each_edge = [&](const auto& visit) {
      for (const Triangle& t : tree_.surface().triangles)
        for (std::size_t c = 0; c < 3; ++c) visit(Edge{t[c], t[(c + 1) % 3]});
    };
    each_edge([&](const Edge& e) {
      if (!all.insert(e).second || e[0] == e[1]) mark(e);
    });
    each_edge([&](const Edge& e) {
      if (!all.contains({e[1], e[0]})) mark(e);
    });
  }

  void fill_subtree(Ref ref, const std::vector<Index>& below) {
    Subtree& subtree = subtrees_[NormalCones::slot(tree_, ref)];
    for (const Index t : below)
      for (const Index v : triangle(t))
        if (border_[local(v)] != 0) return;
    subtree.closed = true;

    std::vector<Index> all;  // P⁺
    for (const Index t : below)
      for (const Index v : triangle(t)) all.insert(all.end(), around_[local(v)].begin(), around_[local(v)].end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());

    std::unordered_set<Edge, EdgeHash> edges;
    for (const Index t : all)
      for (std::size_t c = 0; c < 3; ++c) edges.insert({triangle(t)[c], triangle(t)[(c + 1) % 3]});
    for (const Index t : all)
      for (std::size_t c = 0; c < 3; ++c)
        if (!edges.contains({triangle(t)[(c + 1) % 3], triangle(t)[c]}))
          subtree.contour.push_back({triangle(t)[c], triangle(t)[(c + 1) % 3]});

    std::vector<std::size_t> own, ring;
    for (const Index t : below) own.push_back(leaf_of_[t]);
    for (const Index t : all) ring.push_back(leaf_of_[t]);
    for (auto* leaves : {&own, &ring}) {
      std::sort(leaves->begin(), leaves->end());
      leaves->erase(std::unique(leaves->begin(), leaves->end()), leaves->end());
    }
    for (const std::size_t leaf : ring)
      if (!std::binary_search(own.begin(), own.end(), leaf)) subtree.ring.push_back(~static_cast<Ref>(leaf));
  }

  const Tree<K>& tree_;
  std::vector<Subtree>& subtrees_;
  std::vector<std::vector<Index>> around_;  // triangles at each vertex
  std::vector<std::size_t> leaf_of_;        // by triangle
  std::vector<std::uint8_t> border_;        // by vertex
};

template <int K>
std::size_t NormalCones<K>::slot(const Tree<K>& tree, Ref ref) {
  return ref >= 0 ? static_cast<std::size_t>(ref) : tree.nodes().size() + static_cast<std::size_t>(~ref);
}

template <int K>
NormalCones<K>::NormalCones(const Tree<K>& tree) {
  const std::size_t slots = tree.nodes().size() + tree.leaves().size();
  subtrees_.resize(slots);
  cones_.resize(slots);
  regions_.node.resize(tree.nodes().size());
  regions_.leaf.resize(tree.leaves().size());
  if (!tree.empty()) Builder(tree, subtrees_).build(tree.root());
}

template <int K>
void NormalCones<K>::fit_leaf(const typename Tree<K>::Leaf& leaf, std::span<const Vec3> x_t0,
                              std::span<const Vec3> x_t1, Cone& cone) const {
  // During the step, the normal of a triangle is a quadratic function of time. `normals`: its Bernstein coefficients,
  // per lane.
  std::array<std::array<Vec3, 3>, kLanes> normals;
  Vec3 sum = Vec3::Zero();
  cone.altitude = 1e300;
  for (int l = 0; l < leaf.count; ++l) {
    const auto corner = [&](std::span<const Vec3> x, int c) -> const Vec3& { return x[leaf.corners.corner[c][l]]; };
    const Vec3 e0 = corner(x_t0, 1) - corner(x_t0, 0), f0 = corner(x_t0, 2) - corner(x_t0, 0);
    const Vec3 e1 = corner(x_t1, 1) - corner(x_t1, 0), f1 = corner(x_t1, 2) - corner(x_t1, 0);
    auto& n = normals[l];
    n = {e0.cross(f0), 0.5 * (e0.cross(f1) + e1.cross(f0)), e1.cross(f1)};
    sum += n[0] + n[2];
    const double longest_sq = std::max({e0.squaredNorm(), f0.squaredNorm(), (f0 - e0).squaredNorm(), e1.squaredNorm(),
                                        f1.squaredNorm(), (f1 - e1).squaredNorm()});
    const double least_sq = std::min({n[0].squaredNorm(), n[1].squaredNorm(), n[2].squaredNorm()});
    cone.altitude = std::min(cone.altitude, std::sqrt(least_sq / std::max(longest_sq, 1e-300)));
  }
  cone.axis = sum.normalized();
  cone.cosine = 1;
  for (int l = 0; l < leaf.count; ++l)
    for (const Vec3& n : normals[l]) {
      const double along = cone.axis.dot(n);
      if (!(along > 0)) {
        cone.cosine = -1;
        return;
      }
      cone.cosine = std::min(cone.cosine, along / n.norm());
    }
  cone.cosine -= kRoundoff;
  cone.sine = std::sqrt(std::max(0.0, 1 - cone.cosine * cone.cosine));
}

/// The cone around the mean axis that contains all given cones.
template <int K>
typename NormalCones<K>::Cone NormalCones<K>::join(std::span<const Cone* const> cones) {
  Cone all;
  all.altitude = 1e300;
  for (const Cone* part : cones) {
    if (part->cosine <= 0) return {};
    all.axis += part->axis;
    all.altitude = std::min(all.altitude, part->altitude);
  }
  all.axis.normalize();
  all.cosine = 1;
  for (const Cone* part : cones) {
    // cos(α + β), where α is the half-angle of `part` and β the angle between the axes. Both angles are below 90°, so a
    // smaller cosine means a larger sum.
    const double between = all.axis.dot(part->axis);
    if (!(between > 0)) return {};
    const double across = std::sqrt(std::max(0.0, 1 - between * between));
    all.cosine = std::min(all.cosine, part->cosine * between - part->sine * across);
  }
  all.cosine -= kRoundoff;
  all.sine = std::sqrt(std::max(0.0, 1 - all.cosine * all.cosine));
  return all;
}

template <int K>
void NormalCones<K>::update(const Tree<K>& tree, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                            double detection_distance) {
  if (tree.empty()) return;
  const std::size_t nodes = tree.nodes().size();
  for (std::size_t n = 0; n < tree.leaves().size(); ++n) fit_leaf(tree.leaves()[n], x_t0, x_t1, cones_[nodes + n]);
  for (std::size_t n = nodes; n-- > 0;) {
    const auto& node = tree.nodes()[n];
    std::array<const Cone*, kLanes> cones;
    for (int i = 0; i < node.count; ++i) cones[i] = &cones_[slot(tree, node.child[i])];
    cones_[n] = join(std::span(cones).first(static_cast<std::size_t>(node.count)));
  }
  std::fill(regions_.node.begin(), regions_.node.end(), std::uint8_t{0});
  std::fill(regions_.leaf.begin(), regions_.leaf.end(), std::uint8_t{0});
  mark_flat_regions(tree, tree.root(), x_t0, x_t1, detection_distance);
}

template <int K>
bool NormalCones<K>::has_nothing_near(const Tree<K>& tree, Ref ref, std::span<const Vec3> x_t0,
                                      std::span<const Vec3> x_t1, double detection_distance) const {
  const Cone& own = cones_[slot(tree, ref)];
  const Subtree& subtree = subtrees_[slot(tree, ref)];
  const double needed = detection_distance * (1 + kRoundoff);
  if (!subtree.closed || own.cosine * own.altitude <= needed || own.cosine <= 0) return false;
  std::vector<const Cone*> cones{&own};
  for (const Ref leaf : subtree.ring) cones.push_back(&cones_[slot(tree, leaf)]);
  const Cone all = join(cones);
  return all.cosine > 0 && all.cosine * all.altitude > needed && is_star_shaped(subtree.contour, all.axis, x_t0, x_t1);
}

/// Marks flat regions top-down. self_pairs() skips a marked subtree as a whole, so the nodes below it are not marked.
template <int K>
void NormalCones<K>::mark_flat_regions(const Tree<K>& tree, Ref ref, std::span<const Vec3> x_t0,
                                       std::span<const Vec3> x_t1, double detection_distance) {
  const bool is_flat = has_nothing_near(tree, ref, x_t0, x_t1, detection_distance);
  auto& flags = ref >= 0 ? regions_.node : regions_.leaf;
  flags[ref >= 0 ? ref : ~ref] = static_cast<std::uint8_t>(is_flat);
  if (is_flat || ref < 0) return;
  const auto& node = tree.nodes()[ref];
  for (int i = 0; i < node.count; ++i) mark_flat_regions(tree, node.child[i], x_t0, x_t1, detection_distance);
}

template class NormalCones<6>;
template class NormalCones<18>;
template class NormalCones<26>;

}  // namespace weft::collision
