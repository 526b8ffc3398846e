#include "film/assets/mending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/disjoint_sets.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::assets {
namespace {

/// A detached piece is removed if its area is smaller than this fraction of the area of the surface.
constexpr double kMaxSmallPieceArea = 0.02;
/// Detached vertices move toward the mean of their triangles' centroids, by this fraction of the distance.
constexpr double kCutGap = 0.2;
/// Maximum length of a collapsed edge, relative to the minimum height of triangles.
constexpr double kMaxCollapseRatio = 8;
/// Factor on the required height of triangles. The margin is for rest shapes from UVs, which differ from the mesh.
constexpr double kHeightMargin = 1.1;
constexpr int kMaxCollapseRounds = 8;

using mesh::Triangle;

double area(const LoadedMesh& loaded, std::size_t t) {
  const auto& [a, b, c] = loaded.mesh.topology.triangles[t];
  const std::vector<Vec3>& x = loaded.mesh.positions;
  return 0.5 * (x[at(b)] - x[at(a)]).cross(x[at(c)] - x[at(a)]).norm();
}

std::size_t corner_of(const Triangle& t, Index vertex) {
  return t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
}

void keep_triangles(LoadedMesh& loaded, const std::vector<std::uint8_t>& kept) {
  std::vector<Triangle>& triangles = loaded.mesh.topology.triangles;
  std::size_t to = 0;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (kept[t] == 0) continue;
    triangles[to] = triangles[t];
    if (!loaded.uv.empty()) loaded.uv[to] = loaded.uv[t];
    ++to;
  }
  triangles.resize(to);
  if (!loaded.uv.empty()) loaded.uv.resize(to);
}

/// Keeps only the vertices that triangles use, in the order of use. `from`: for each vertex, the original vertex whose
/// colour and groups it gets; empty: itself.
void keep_vertices(LoadedMesh& loaded, const std::vector<Index>& from = {}) {
  std::vector<Index> renamed(loaded.mesh.positions.size(), -1), kept;
  for (Triangle& t : loaded.mesh.topology.triangles)
    for (Index& v : t) {
      if (renamed[at(v)] < 0) {
        renamed[at(v)] = static_cast<Index>(kept.size());
        kept.push_back(v);
      }
      v = renamed[at(v)];
    }
  LoadedMesh result;
  for (const Index v : kept) {
    const std::size_t original = at(from.empty() ? v : from[at(v)]);
    result.mesh.positions.push_back(loaded.mesh.positions[at(v)]);
    if (!loaded.colors.empty()) result.colors.push_back(loaded.colors[original]);
    for (const auto& [name, weights] : loaded.groups) result.groups[name].push_back(weights[original]);
  }
  loaded.mesh.positions = std::move(result.mesh.positions);
  loaded.colors = std::move(result.colors);
  loaded.groups = std::move(result.groups);
}

std::size_t remove_duplicates(LoadedMesh& loaded) {
  std::set<Triangle> seen;
  std::vector<std::uint8_t> kept;
  for (Triangle t : loaded.mesh.topology.triangles) {
    std::ranges::sort(t);
    kept.push_back(seen.insert(t).second ? 1 : 0);
  }
  keep_triangles(loaded, kept);
  return static_cast<std::size_t>(std::ranges::count(kept, 0));
}

/// Two triangles joined at an edge.
struct Joint {
  Index low, high;  // ends of the edge
  std::size_t t, u;

  bool faces_same_way(const std::vector<Triangle>& triangles) const {
    const auto forward = [&](const Triangle& in) { return in[(corner_of(in, low) + 1) % 3] == high; };
    return forward(triangles[t]) != forward(triangles[u]);
  }
};

/// Pairs the triangles at each edge, the most nearly coplanar ones first. A triangle is in at most one pair per edge.
std::vector<Joint> joints_of(const LoadedMesh& loaded) {
  const std::vector<Triangle>& triangles = loaded.mesh.topology.triangles;
  const std::vector<Vec3>& x = loaded.mesh.positions;
  std::map<std::array<Index, 2>, std::vector<std::size_t>> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      edges[{low, high}].push_back(t);
    }
  std::vector<Joint> joints;
  for (const auto& [edge, sides] : edges) {
    const Vec3 along = (x[at(edge[1])] - x[at(edge[0])]).normalized();
    std::vector<Vec3> inward;
    for (const std::size_t t : sides) {
      const auto& [a, b, c] = triangles[t];
      const Vec3 to = x[at(a)] + x[at(b)] + x[at(c)] - 3 * x[at(edge[0])];
      inward.push_back((to - to.dot(along) * along).normalized());
    }
    std::vector<std::pair<double, std::array<std::size_t, 2>>> pairs;
    for (std::size_t i = 0; i < sides.size(); ++i)
      for (std::size_t j = i + 1; j < sides.size(); ++j) pairs.push_back({inward[i].dot(inward[j]), {i, j}});
    std::ranges::stable_sort(pairs, {}, [](const auto& pair) { return pair.first; });
    std::vector<std::uint8_t> taken(sides.size(), 0);
    for (const auto& [dot, pair] : pairs) {
      if (taken[pair[0]] != 0 || taken[pair[1]] != 0) continue;
      taken[pair[0]] = taken[pair[1]] = 1;
      joints.push_back({edge[0], edge[1], sides[pair[0]], sides[pair[1]]});
    }
  }
  return joints;
}

/// Gives all triangles of a connected piece the orientation that most of its area has. Returns the number of flipped
/// triangles.
std::size_t orient_pieces(LoadedMesh& loaded, const std::vector<Joint>& joints) {
  std::vector<Triangle>& triangles = loaded.mesh.topology.triangles;
  // Neighbours of each triangle, and whether they face the same way.
  std::vector<std::vector<std::pair<std::size_t, bool>>> next(triangles.size());
  for (const Joint& joint : joints) {
    const bool same_way = joint.faces_same_way(triangles);
    next[joint.t].emplace_back(joint.u, same_way);
    next[joint.u].emplace_back(joint.t, same_way);
  }
  std::size_t flipped = 0;
  std::vector<int> orientation(triangles.size(), 0);
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (orientation[first] != 0) continue;
    std::vector<std::size_t> piece{first};
    orientation[first] = 1;
    double balance = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      balance += orientation[piece[i]] * area(loaded, piece[i]);
      for (const auto& [other, same_way] : next[piece[i]])
        if (orientation[other] == 0) {
          orientation[other] = same_way ? orientation[piece[i]] : -orientation[piece[i]];
          piece.push_back(other);
        }
    }
    for (const std::size_t t : piece) {
      if (orientation[t] * balance >= 0) continue;
      std::swap(triangles[t][1], triangles[t][2]);
      if (!loaded.uv.empty()) std::swap(loaded.uv[t][1], loaded.uv[t][2]);
      ++flipped;
    }
  }
  return flipped;
}

/// Repairs each edge that more than two triangles share, or two triangles of opposite orientation: detaches the
/// triangles that `joints` do not join, or join with opposite orientations. Detached triangles get vertices of their
/// own, which are moved away from the edge. Removes small detached pieces.
void cut_non_manifold_edges(LoadedMesh& loaded, const std::vector<Joint>& joints, MendingReport& mended) {
  std::vector<Triangle>& triangles = loaded.mesh.topology.triangles;
  const mesh::TopologyReport report = mesh::inspect(triangles, loaded.mesh.positions.size());
  mended.cut_edges = report.non_manifold.size() + report.misoriented.size();
  if (mended.cut_edges == 0) return;
  std::vector<std::uint8_t> at_cut(loaded.mesh.positions.size(), 0);
  for (const auto& edges : {report.non_manifold, report.misoriented})
    for (const auto& edge : edges) at_cut[at(edge[0])] = at_cut[at(edge[1])] = 1;
  DisjointSets corners(3 * triangles.size());
  const auto corner = [&](std::size_t t, Index vertex) {
    return static_cast<Index>(3 * t + corner_of(triangles[t], vertex));
  };
  std::vector<Index> first(loaded.mesh.positions.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index v : triangles[t]) {
      if (at_cut[at(v)] != 0) continue;
      if (first[at(v)] < 0) first[at(v)] = corner(t, v);
      corners.join(first[at(v)], corner(t, v));
    }
  for (const Joint& joint : joints)
    if (joint.faces_same_way(triangles))
      for (const Index v : {joint.low, joint.high}) corners.join(corner(joint.t, v), corner(joint.u, v));
  // Each set of joined corners becomes a vertex; vertices connected by triangles form a piece.
  std::vector<Index> from(3 * triangles.size());
  std::vector<Vec3> positions(from.size());
  std::vector<Triangle> cut_triangles(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = cut_triangles[t][k] = corners.root(static_cast<Index>(3 * t + k));
      from[at(vertex)] = triangles[t][k];
      positions[at(vertex)] = loaded.mesh.positions[at(triangles[t][k])];
    }
  const std::vector<Index> piece_of = mesh::components(cut_triangles, from.size());
  std::map<Index, double> areas;
  double whole = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    areas[piece_of[at(cut_triangles[t][0])]] += area(loaded, t);
    whole += area(loaded, t);
  }
  // One copy of each vertex keeps its position: the copy in the largest piece. If this piece has several copies, it is
  // the copy that most triangles use.
  std::map<Index, std::pair<double, Index>> kept_copies;
  std::vector<int> use_count(from.size(), 0);
  for (const Triangle& t : cut_triangles)
    for (const Index v : t) ++use_count[at(v)];
  std::set<Index> small_pieces;
  for (const Triangle& t : cut_triangles)
    for (const Index v : t) {
      if (at_cut[at(from[at(v)])] == 0) continue;
      const double size = areas[piece_of[at(v)]];
      auto& [largest, copy] = kept_copies.try_emplace(from[at(v)], -1, -1).first->second;
      if (const double key = size + 1e-9 * whole * use_count[at(v)]; key > largest) largest = key, copy = v;
      if (size < kMaxSmallPieceArea * whole) small_pieces.insert(piece_of[at(v)]);
    }
  std::vector<std::uint8_t> kept;
  std::vector<Vec3> toward(from.size(), Vec3::Zero());
  for (const Triangle& t : cut_triangles) {
    kept.push_back(small_pieces.contains(piece_of[at(t[0])]) ? 0 : 1);
    const Vec3 middle = (positions[at(t[0])] + positions[at(t[1])] + positions[at(t[2])]) / 3;
    for (const Index v : t) toward[at(v)] += (middle - positions[at(v)]) / use_count[at(v)];
  }
  for (std::size_t v = 0; v < from.size(); ++v)
    if (const auto kept_copy = kept_copies.find(from[v]);
        use_count[v] > 0 && kept_copy != kept_copies.end() && static_cast<Index>(v) != kept_copy->second.second)
      positions[v] += kCutGap * toward[v];
  for (const Index piece : small_pieces) mended.left_out += areas[piece] / whole;
  mended.pieces = small_pieces.size();
  triangles = std::move(cut_triangles);
  loaded.mesh.positions = std::move(positions);
  keep_triangles(loaded, kept);
  keep_vertices(loaded, from);
}

/// Repairs edges that cut_non_manifold_edges() could not repair because other triangles connect both sides: keeps only
/// the most nearly coplanar pair of triangles of the same orientation, and removes the others.
void remove_surplus_triangles(LoadedMesh& loaded, MendingReport& mended) {
  const std::vector<Triangle>& triangles = loaded.mesh.topology.triangles;
  double whole = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) whole += area(loaded, t);
  std::map<std::array<Index, 2>, std::vector<std::size_t>> joined;
  for (const Joint& joint : joints_of(loaded))
    if (auto& pair = joined[{joint.low, joint.high}]; pair.empty() && joint.faces_same_way(triangles))
      pair = {joint.t, joint.u};
  const mesh::TopologyReport report = mesh::inspect(triangles, loaded.mesh.positions.size());
  std::set<std::array<Index, 2>> wrong(report.non_manifold.begin(), report.non_manifold.end());
  wrong.insert(report.misoriented.begin(), report.misoriented.end());
  std::vector<std::uint8_t> kept(triangles.size(), 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      const std::array edge{low, high};
      if (wrong.contains(edge) && std::ranges::find(joined[edge], t) == joined[edge].end()) kept[t] = 0;
    }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (kept[t] == 0) mended.left_out += area(loaded, t) / whole, ++mended.pieces;
  keep_triangles(loaded, kept);
}

/// Removes flat triangles one by one: collapses their shortest edge if possible, otherwise flips their longest edge.
class EdgeCollapser {
 public:
  EdgeCollapser(LoadedMesh& loaded, double flattest)
      : loaded_(loaded), triangles_(loaded.mesh.topology.triangles), around_(loaded.mesh.positions.size()) {
    double longest = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        around_[at(triangles_[t][k])].push_back(t);
        longest = std::max(longest, length(t, k));
      }
    min_height_ = flattest * longest;
    for (const auto& [a, b] : mesh::inspect(triangles_, around_.size()).border) on_border_.insert({a, b});
  }

  std::size_t run() {
    std::size_t collapsed = 0;
    std::vector<std::uint8_t> kept(triangles_.size(), 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      std::size_t shortest = 0;
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (length(t, k) < length(t, shortest)) shortest = k;
        longest = std::max(longest, length(t, k));
      }
      if (kept[t] == 0 || 2 * area(loaded_, t) >= min_height_ * longest) continue;
      const Index a = triangles_[t][shortest], b = triangles_[t][(shortest + 1) % 3];
      const bool is_short = length(t, shortest) <= kMaxCollapseRatio * min_height_;
      if ((is_short && (collapse(a, b, kept) || collapse(b, a, kept))) || flip(t)) ++collapsed;
    }
    if (collapsed == 0) return 0;
    keep_triangles(loaded_, kept);
    keep_vertices(loaded_);
    return collapsed;
  }

 private:
  double length(std::size_t t, std::size_t k) const {
    return (loaded_.mesh.positions[at(triangles_[t][(k + 1) % 3])] - loaded_.mesh.positions[at(triangles_[t][k])])
        .norm();
  }
  bool is_on_border(Index v) const {
    return std::ranges::any_of(around_[at(v)], [&](std::size_t t) {
      return std::ranges::any_of(triangles_[t], [&](Index w) { return on_border_.contains(std::minmax(v, w)); });
    });
  }
  std::set<Index> neighbours(Index v) const {
    std::set<Index> all;
    for (const std::size_t t : around_[at(v)]) all.insert(triangles_[t].begin(), triangles_[t].end());
    all.erase(v);
    return all;
  }

  /// Merges vertex b into vertex a, and removes the triangles that contain both. If this would change the border, join
  /// separate parts, reverse or flatten a triangle, or make the UVs discontinuous, does nothing and returns false.
  bool collapse(Index a, Index b, std::vector<std::uint8_t>& kept) {
    const bool border_edge = on_border_.contains(std::minmax(a, b));
    if (is_on_border(b) && !border_edge) return false;
    std::vector<std::size_t> between, moved;
    for (const std::size_t t : around_[at(b)])
      (std::ranges::find(triangles_[t], a) != triangles_[t].end() ? between : moved).push_back(t);
    const std::set<Index> of_a = neighbours(a), of_b = neighbours(b);
    const auto common = std::ranges::count_if(of_a, [&](Index v) { return of_b.contains(v); });
    if (between.size() != (border_edge ? 1U : 2U) || static_cast<std::size_t>(common) != between.size()) return false;
    std::vector<Vec2> uv;  // UVs of the corners at b
    for (const std::size_t t : moved) {
      if (would_flip(t, b, a)) return false;
      if (loaded_.uv.empty()) continue;
      const Vec2& here = loaded_.uv[t][corner_of(triangles_[t], b)];
      const auto same = std::ranges::find_if(
          between, [&](std::size_t u) { return loaded_.uv[u][corner_of(triangles_[u], b)] == here; });
      if (same == between.end()) return false;
      uv.push_back(loaded_.uv[*same][corner_of(triangles_[*same], a)]);
    }
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const std::size_t t = moved[i], corner = corner_of(triangles_[t], b);
      triangles_[t][corner] = a;
      if (!uv.empty()) loaded_.uv[t][corner] = uv[i];
      around_[at(a)].push_back(t);
    }
    for (const std::size_t t : between) {
      kept[t] = 0;
      for (const Index v : triangles_[t]) std::erase(around_[at(v)], t);
    }
    around_[at(b)].clear();
    if (!border_edge) return true;
    for (const Index v : of_b)
      if (on_border_.erase(std::minmax(b, v)) > 0 && v != a) on_border_.insert(std::minmax(a, v));
    return true;
  }

  /// Flips the longest edge of a flat triangle if the UVs are continuous there, and if this increases the smaller of
  /// the heights of both triangles. Returns whether it did.
  bool flip(std::size_t t) {
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (length(t, i) > length(t, k)) k = i;
    const Index a = triangles_[t][k], b = triangles_[t][(k + 1) % 3], c = triangles_[t][(k + 2) % 3];
    const auto other = std::ranges::find_if(around_[at(a)], [&](std::size_t u) {
      return u != t && std::ranges::find(triangles_[u], b) != triangles_[u].end();
    });
    if (other == around_[at(a)].end()) return false;
    const std::size_t u = *other;
    const std::size_t u_a = corner_of(triangles_[u], a), u_b = corner_of(triangles_[u], b), u_d = 3 - u_a - u_b;
    const Index d = triangles_[u][u_d];
    if (neighbours(c).contains(d)) return false;
    const Triangle first{a, d, c}, second{d, b, c};
    if (std::min(height(first), height(second)) <= std::min(height(triangles_[t]), height(triangles_[u]))) return false;
    if (!loaded_.uv.empty()) {
      auto &of_t = loaded_.uv[t], &of_u = loaded_.uv[u];
      if (of_t[k] != of_u[u_a] || of_t[(k + 1) % 3] != of_u[u_b]) return false;
      const std::array<Vec2, 3> one{of_t[k], of_u[u_d], of_t[(k + 2) % 3]},
          two{of_u[u_d], of_t[(k + 1) % 3], of_t[(k + 2) % 3]};
      of_t = one;
      of_u = two;
    }
    triangles_[t] = first;
    triangles_[u] = second;
    std::erase(around_[at(a)], u);
    std::erase(around_[at(b)], t);
    around_[at(c)].push_back(u);
    around_[at(d)].push_back(t);
    return true;
  }

  double height(const Triangle& t) const {
    const std::vector<Vec3>& x = loaded_.mesh.positions;
    const Vec3 ab = x[at(t[1])] - x[at(t[0])], bc = x[at(t[2])] - x[at(t[1])], ca = x[at(t[0])] - x[at(t[2])];
    return ab.cross(bc).norm() / std::max({ab.norm(), bc.norm(), ca.norm()});
  }

  /// Whether triangle t would reverse its orientation or lose its area if its vertex b moved to vertex a.
  bool would_flip(std::size_t t, Index b, Index a) const {
    const std::vector<Vec3>& x = loaded_.mesh.positions;
    Triangle after = triangles_[t];
    after[corner_of(after, b)] = a;
    const auto normal = [&](const Triangle& in) {
      return Vec3((x[at(in[1])] - x[at(in[0])]).cross(x[at(in[2])] - x[at(in[0])]));
    };
    const Vec3 was = normal(triangles_[t]), is = normal(after);
    return is.norm() <= 0 || was.dot(is) < 0;
  }

  LoadedMesh& loaded_;
  std::vector<Triangle>& triangles_;
  std::vector<std::vector<std::size_t>> around_;  // triangles around each vertex
  std::set<std::pair<Index, Index>> on_border_;
  double min_height_ = 0;  // triangles of smaller height are flat [m]
};

}  // namespace

std::string MendingReport::describe() const {
  std::string text;
  const auto append = [&](std::size_t count, const std::string& what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  append(duplicates, "duplicate triangles left out");
  append(flipped, "triangles flipped to match their neighbours");
  append(cut_edges, "edges of more than two triangles, or that face both ways, cut open");
  if (pieces > 0)
    text += fmt::format(" and {} small pieces there left out, {:.2g} % of the area", pieces, 100 * left_out);
  append(collapsed, "edges of flat triangles collapsed or turned");
  return text;
}

MendingReport mend_sheet(LoadedMesh& loaded, double flattest) {
  MendingReport mended;
  const bool is_sheet = mesh::inspect(loaded.mesh.topology.triangles, loaded.mesh.positions.size()).manifold();
  if (!is_sheet) {
    mended.duplicates = remove_duplicates(loaded);
    const std::vector<Joint> joints = joints_of(loaded);
    mended.flipped = orient_pieces(loaded, joints);
    cut_non_manifold_edges(loaded, joints, mended);
    remove_surplus_triangles(loaded, mended);
  }
  if (!is_sheet || loaded.lost_vertices > 0) keep_vertices(loaded);
  // Repeats this, because collapsing and flipping can make other triangles flat.
  for (int round = 0; round < kMaxCollapseRounds; ++round) {
    const std::size_t collapsed = EdgeCollapser(loaded, kHeightMargin * flattest).run();
    mended.collapsed += collapsed;
    if (collapsed == 0) break;
  }
  return mended;
}

}  // namespace weft::assets
