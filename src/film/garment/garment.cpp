#include "film/garment/garment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "core/error.hpp"
#include "film/garment/start_shape.hpp"
#include "film/garment/wrapping.hpp"

namespace weft::garment {
namespace {

// Minimum distance of bent panels from the skin at the start, as a fraction of Pattern::gap.
constexpr double kClearanceRatio = 0.6;
// Panel edges shorter than this fraction of the spacing become points: narrow triangles there would be very stiff.
constexpr double kPointEdgeRatio = 0.25;
// Minimum area of a triangle after an edge flip, relative to that of a lattice square.
constexpr double kMinFlippedArea = 0.02;
// Maximum number of particles of one garment, estimated as area of the panels / spacing².
constexpr double kMaxParticles = 1e6;

/// Makes a garment. A "point" belongs to the mesh of one panel; the points of all panels are numbered consecutively. A
/// "vertex" belongs to the garment: it is a point, or several points that seams join.
class Sewing {
 public:
  Sewing(const Pattern& pattern, double spacing, const std::string& where, const Wearer* wearer)
      : pattern_(pattern), spacing_(spacing), where_(where), wearer_(wearer) {}

  Garment sew() {
    if (pattern_.has_bent_panels() && wearer_ == nullptr)
      refuse("expected a wearer, as panels start around parts of a body; got none");
    count_segments();
    mesh_panels();
    number_points();
    join_seams();
    separate_shared_edges();
    number_vertices();
    make_triangles();
    if (wearer_ != nullptr)
      place_around();
    else
      place_flat();
    garment_.sheet.sewn = true;
    add_bands();
    add_closures();
    check();
    return std::move(garment_);
  }

 private:
  [[noreturn]] void refuse(const std::string& text) const {
    throw Error(ExitCode::scene_invalid, "{}: pattern {}: {}", where_, pattern_.file.string(), text);
  }
  double length(std::size_t panel, std::size_t edge) const {
    return Arclength(pattern_.panels[panel].edges[edge].curves).length();
  }
  int segments_for(double length) const {
    return length < kPointEdgeRatio * spacing_ ? 0 : std::max(1, static_cast<int>(std::lround(length / spacing_)));
  }

  // Chooses the number of segments of each edge; both sides of a seam get the same number.
  void count_segments() {
    double area = 0;
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p) {
      std::vector<Vec2> outline;
      auto& counts = segments_.emplace_back();
      for (std::size_t e = 0; e < pattern_.panels[p].edges.size(); ++e) {
        counts.push_back(segments_for(length(p, e)));
        std::ranges::copy(sample_points(pattern_.panels[p].edges[e].curves), std::back_inserter(outline));
      }
      area += std::abs(polygon_area(outline));
    }
    if (area > kMaxParticles * spacing_ * spacing_)
      refuse(fmt::format("expected an edge_length of at least {:.2g} m, which {:g} particles need, got {} m",
                         std::sqrt(area / kMaxParticles), kMaxParticles, spacing_));
    for (const Seam& seam : pattern_.seams) {
      const auto [p, e] = pattern_.find(seam.a);
      const auto [q, f] = pattern_.find(seam.b);
      segments_[p][e] = segments_[q][f] = segments_for(0.5 * (length(p, e) + length(q, f)));
    }
  }

  void mesh_panels() {
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p) {
      const Panel& panel = pattern_.panels[p];
      const int count = std::accumulate(segments_[p].begin(), segments_[p].end(), 0);
      if (count < 3)
        refuse(fmt::format("panel {}: expected an edge_length that leaves it three sides, got {} m", panel.name,
                           spacing_));
      meshes_.push_back(mesh_of(panel, segments_[p], spacing_));
      if (meshes_.back().triangles.empty()) refuse(fmt::format("panel {}: expected an area, got none", panel.name));
    }
  }
  void number_points() {
    first_point_.clear();
    point_count_ = 0;
    for (const FlatMesh& mesh : meshes_) {
      first_point_.push_back(point_count_);
      point_count_ += static_cast<Index>(mesh.points.size());
    }
  }

  // The points of an edge of a panel, in the order of the outline.
  std::vector<Index> chain(std::size_t panel, std::size_t edge) const {
    const auto& counts = segments_[panel];
    const Index begin = std::accumulate(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(edge), 0);
    const Index around = std::accumulate(counts.begin(), counts.end(), 0);
    std::vector<Index> points;
    for (Index k = 0; k <= counts[edge]; ++k) points.push_back(first_point_[panel] + (begin + k) % around);
    return points;
  }
  // Start position (across, up) of the point `p` of a flat panel, before seams join the panel to others [m].
  Vec2 start_position(std::size_t panel, const Vec2& p) const {
    const Panel& of = pattern_.panels[panel];
    const Eigen::Rotation2Dd turn(of.rotation * std::numbers::pi / 180);
    return of.position.value_or(Vec2(0, 0)) + turn * Vec2(of.scale.cwiseProduct(p));
  }
  Vec2 start_of_point(std::size_t panel, Index point) const {
    return start_position(panel, meshes_[panel].points[at(point - first_point_[panel])]);
  }

  // The points `b` of the second edge of a seam can correspond to the points `a` of the first in two directions. Gives
  // `b` the direction in which the first and last points of both edges are closer together at the start, as `distance`
  // tells. If `by_fronts`, and for closed edges such as a whole outline, uses the direction in which the fronts of both
  // panels face outward.
  template <class Distance>
  static void align(const std::vector<Index>& a, std::vector<Index>& b, const Panel& panel_a, const Panel& panel_b,
                    bool by_fronts, const Distance& distance) {
    by_fronts = by_fronts || a.front() == a.back() || b.front() == b.back();
    const double straight = distance(a.front(), b.front()) + distance(a.back(), b.back());
    const double crossed = distance(a.front(), b.back()) + distance(a.back(), b.front());
    if (by_fronts ? are_drawn_from_same_side(panel_a, panel_b) : !(straight < crossed)) std::ranges::reverse(b);
  }

  // Joins the points of both edges of each seam, except closures.
  void join_seams() {
    sewn_together_ = DisjointSets(at(point_count_));
    garment_.seams.clear();
    for (const Seam& seam : pattern_.seams) {
      if (seam.is_closure()) continue;
      const auto [p, e] = pattern_.find(seam.a);
      const auto [q, f] = pattern_.find(seam.b);
      const std::vector<Index> a = chain(p, e);
      std::vector<Index> b = chain(q, f);
      align(a, b, pattern_.panels[p], pattern_.panels[q], wearer_ != nullptr,
            [&, p = p, q = q](Index i, Index j) { return (start_of_point(p, i) - start_of_point(q, j)).norm(); });
      for (std::size_t k = 0; k < a.size(); ++k) sewn_together_.join(a[k], b[k]);
      garment_.seams.push_back({a, length(p, e), length(q, f)});
    }
  }

  /// Removes inner edges of a panel that connect the same two vertices as an edge of another panel, or a vertex with
  /// itself. Such edges occur if two panels, or two edges of one panel, are sewn together around a corner, and a
  /// triangle cuts off the corner. Flips them if possible; otherwise, as in sharp corners, splits them at their middle.
  /// Of two such edges, changes the edge of the panel with the higher index.
  void separate_shared_edges() {
    constexpr int kMaxRounds = 16;  // rarely, edges remain; check_surface() then refuses the pattern
    for (int round = 0; round < kMaxRounds; ++round) {
      std::map<JoinedEdge, int> triangles_at;
      for (std::size_t p = 0; p < meshes_.size(); ++p)
        for (const mesh::Triangle& t : meshes_[p].triangles)
          for (std::size_t k = 0; k < 3; ++k) ++triangles_at[joined_edge(p, t[k], t[(k + 1) % 3])];
      const auto change_edges = [&](bool split) {
        bool changed = false;
        for (std::size_t p = meshes_.size(); p-- > 0;)
          changed = change_shared_edges_of_panel(p, split, triangles_at) || changed;
        return changed;
      };
      if (change_edges(false)) continue;
      if (!change_edges(true)) return;
      number_points();  // splitting adds points
      join_seams();
    }
  }
  using JoinedEdge = std::array<Index, 2>;
  JoinedEdge joined_edge(std::size_t panel, Index a, Index b) {
    const Index u = sewn_together_.root(first_point_[panel] + a), v = sewn_together_.root(first_point_[panel] + b);
    return {std::min(u, v), std::max(u, v)};
  }
  // Splits edges, or flips them. `triangles_at`: number of triangles at each edge of the garment. Returns whether any
  // edge was changed.
  bool change_shared_edges_of_panel(std::size_t panel, bool split, std::map<JoinedEdge, int>& triangles_at) {
    std::vector<mesh::Triangle>& triangles = meshes_[panel].triangles;
    std::vector<Vec2>& points = meshes_[panel].points;
    const double min_area = kMinFlippedArea * spacing_ * spacing_;
    const auto area = [&](Index a, Index b, Index c) {
      return polygon_area(std::array{points[at(a)], points[at(b)], points[at(c)]});
    };
    bool any = false;
    const mesh::EdgeSet table = mesh::collect_edges(triangles);
    std::vector<char> changed(triangles.size(), 0);
    for (const mesh::Edge& edge : table.edges) {
      if (edge.triangles[1] < 0) continue;
      const Index a = edge.vertices[0], b = edge.vertices[1];
      const JoinedEdge joined = joined_edge(panel, a, b);
      int& count = triangles_at[joined];
      const std::size_t first = at(edge.triangles[0]), second = at(edge.triangles[1]);
      if ((count <= 2 && joined[0] != joined[1]) || changed[first] || changed[second]) continue;
      const auto opposite = [&](const mesh::Triangle& t) {
        return *std::ranges::find_if(t, [&](Index v) { return v != a && v != b; });
      };
      // The edge runs from `from` to `to`. Both triangles together have the corners `from`, `right`, `to`, `left`,
      // counter-clockwise.
      const mesh::Triangle& one = triangles[first];
      const std::size_t k = at(static_cast<Index>(std::ranges::find(one, opposite(one)) - one.begin()));
      const Index left = one[k], from = one[(k + 1) % 3], to = one[(k + 2) % 3], right = opposite(triangles[second]);
      if (split) {
        const auto middle = static_cast<Index>(points.size());
        points.push_back(0.5 * (points[at(from)] + points[at(to)]));
        triangles[first] = {from, middle, left}, triangles[second] = {middle, from, right};
        triangles.push_back({middle, to, left}), triangles.push_back({to, middle, right});
      } else {
        const JoinedEdge other = joined_edge(panel, left, right);
        int& other_count = triangles_at[other];
        if (other_count > 0 || other[0] == other[1] || !(area(from, right, left) > min_area) ||
            !(area(right, to, left) > min_area))
          continue;
        triangles[first] = {from, right, left}, triangles[second] = {right, to, left};
        other_count += 2;
      }
      changed[first] = changed[second] = 1;
      count -= 2;
      any = true;
    }
    return any;
  }

  void number_vertices() {
    vertex_of_point_.assign(at(point_count_), -1);
    for (Index v = 0; v < point_count_; ++v) {
      const Index root = sewn_together_.root(v);
      vertex_of_point_[at(v)] = root == v ? vertex_count_++ : vertex_of_point_[at(root)];
    }
    for (SewnSeam& seam : garment_.seams)
      for (Index& v : seam.vertices) v = vertex_of_point_[at(v)];
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p) {
      const Panel& panel = pattern_.panels[p];
      for (std::size_t e = 0; e < panel.edges.size(); ++e) {
        std::vector<Index> vertices = chain(p, e);
        for (Index& v : vertices) v = vertex_of_point_[at(v)];
        garment_.edges.emplace(panel.name + "." + panel.edges[e].name, std::move(vertices));
      }
    }
  }

  // Makes the triangles of the garment with their rest shapes in the panels.
  void make_triangles() {
    const bool reinforced = std::ranges::any_of(
        pattern_.panels, [](const Panel& panel) { return panel.reinforcement != mesh::Reinforcement{}; });
    for (std::size_t p = 0; p < meshes_.size(); ++p) {
      const Panel& panel = pattern_.panels[p];
      const bool inside = panel.from_inside();
      for (const mesh::Triangle& t : meshes_[p].triangles) {
        mesh::Triangle vertices = joined(p, t);
        std::array<Vec2, 3> material;
        for (std::size_t k = 0; k < 3; ++k) material[k] = along_grain(panel, meshes_[p].points[at(t[k])]);
        // The drawing of a panel from the inside shows the back of the cloth. Exchanges left and right.
        if (inside) {
          std::swap(vertices[1], vertices[2]);
          std::swap(material[1], material[2]);
          for (Vec2& m : material) m.x() = -m.x();
        }
        garment_.sheet.triangles.push_back(vertices);
        garment_.sheet.material.push_back(material);
        if (reinforced) garment_.sheet.reinforcements.push_back(panel.reinforcement);
        garment_.panel_of.push_back(static_cast<Index>(p));
      }
    }
    check_surface();
  }

  void place_flat() {
    std::vector<LaidPanel> laid;
    for (std::size_t p = 0; p < meshes_.size(); ++p) {
      laid.push_back({pattern_.panels[p].side == Side::back, pattern_.panels[p].layer, {}, {}});
      for (const mesh::Triangle& t : meshes_[p].triangles) {
        laid.back().triangles.push_back(joined(p, t));
        auto& corners = laid.back().corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) corners[k] = start_position(p, meshes_[p].points[at(t[k])]);
      }
    }
    garment_.uv = lay_together(laid, at(vertex_count_));
    check_plane(laid);
    garment_.sheet.rest = inflate(laid, garment_.uv, pattern_.depth);
  }

  void place_around() {
    const auto bent = bend_around(pattern_, meshes_, *wearer_, [this](const std::string& text) { refuse(text); });
    std::vector<std::array<Vec3, 3>> corners;
    garment_.uv.assign(at(vertex_count_), Vec2::Zero());
    for (std::size_t p = meshes_.size(); p-- > 0;)
      for (const mesh::Triangle& t : meshes_[p].triangles)
        for (std::size_t k = 0; k < 3; ++k)
          garment_.uv[at(joined(p, t)[k])] = along_grain(pattern_.panels[p], meshes_[p].points[at(t[k])]);
    for (std::size_t p = 0; p < meshes_.size(); ++p)
      for (const mesh::Triangle& t : meshes_[p].triangles) {
        auto& of = corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) of[k] = bent[p][at(t[k])];
        if (pattern_.panels[p].from_inside()) std::swap(of[1], of[2]);
      }
    std::vector<Vec3>& x = garment_.sheet.rest;
    x = join_in_space(garment_.sheet.triangles, corners, at(vertex_count_), spacing_, size_factor(*wearer_));
    move_out_of_skin(*wearer_, garment_.sheet.triangles, kClearanceRatio * pattern_.gap, x);
    for (Vec3& each : x) each = wearer_->to_world * each;
  }
  mesh::Triangle joined(std::size_t p, const mesh::Triangle& t) const {
    return {vertex_of_point_[at(first_point_[p] + t[0])], vertex_of_point_[at(first_point_[p] + t[1])],
            vertex_of_point_[at(first_point_[p] + t[2])]};
  }
  static Vec2 along_grain(const Panel& panel, const Vec2& p) {
    return Eigen::Rotation2Dd(-panel.grain * std::numbers::pi / 180) * p;
  }

  void check_surface() const {
    const mesh::TopologyReport report = mesh::inspect(garment_.sheet.triangles, at(vertex_count_));
    if (!report.manifold())
      refuse(fmt::format(
          "expected seams that make a surface, got {} edges of more than two triangles, {} whose "
          "triangles face both ways and {} triangles that a seam folds; {}",
          report.non_manifold.size(), report.misoriented.size(), report.degenerate.size(),
          report.misoriented.empty() ? "a smaller edge_length may help"
                                     : "panels that lie one on the other need side = \"front\" and side = \"back\""));
  }
  void check_plane(const std::vector<LaidPanel>& laid) const {
    for (std::size_t p = 0; p < laid.size(); ++p)
      for (const mesh::Triangle& t : laid[p].triangles) {
        const std::array<Vec2, 3> c{garment_.uv[at(t[0])], garment_.uv[at(t[1])], garment_.uv[at(t[2])]};
        if (polygon_area(c) > 0) continue;
        refuse(
            fmt::format("panel {}: expected a position, rotation and scale at which its seams close without folding "
                        "it, got a fold near ({:.3f}, {:.3f}) m, across and up",
                        pattern_.panels[p].name, c[0].x(), c[0].y()));
      }
  }

  // A band along an edge, with the rest lengths that the edge has in the pattern.
  mesh::Band band_along(const std::string& edge) const {
    const auto [p, e] = pattern_.find(edge);
    const std::vector<Index> points = chain(p, e);
    mesh::Band band;
    for (std::size_t k = 0; k < points.size(); ++k) {
      band.vertices.push_back(vertex_of_point_[at(points[k])]);
      if (k == 0) continue;
      const auto& of = meshes_[p].points;
      band.lengths.push_back((of[at(points[k] - first_point_[p])] - of[at(points[k - 1] - first_point_[p])]).norm());
    }
    return band;
  }

  void add_bands() {
    std::size_t s = 0;
    for (const Seam& seam : pattern_.seams) {
      if (seam.is_closure()) continue;
      const SewnSeam& sewn = garment_.seams[s++];
      if (seam.allowance == 0 || sewn.vertices.size() < 2) continue;
      // If the edges of a seam differ in length, the seam has their mean length.
      const double mean = 0.5 * (sewn.length_a + sewn.length_b);
      mesh::Band band{.vertices = sewn.vertices, .lengths = {}, .allowance = seam.allowance};
      band.lengths.assign(band.vertices.size() - 1, mean / static_cast<double>(band.vertices.size() - 1));
      garment_.sheet.bands.push_back(std::move(band));
    }
    for (const Elastic& elastic : pattern_.elastics) {
      garment_.sheet.bands.push_back(band_along(elastic.edge));
      garment_.sheet.bands.back().ratio = elastic.ratio;
      garment_.sheet.bands.back().stiffness = elastic.stiffness;
    }
    for (const Hem& hem : pattern_.hems) {
      garment_.sheet.bands.push_back(band_along(hem.edge));
      garment_.sheet.bands.back().mass = hem.mass;
      garment_.sheet.bands.back().bend = hem.bend;
    }
  }

  // Adds the ties of closures.
  void add_closures() {
    const std::vector<Vec3>& x = garment_.sheet.rest;
    for (const Seam& seam : pattern_.seams) {
      if (!seam.is_closure()) continue;
      if (seam.tearing_load) garment_.sheet.tearing_seams.push_back(seam.a + " + " + seam.b);
      const std::vector<Index>& a = garment_.edges.at(seam.a);
      std::vector<Index> b = garment_.edges.at(seam.b);
      align(a, b, pattern_.panels[pattern_.find(seam.a).first], pattern_.panels[pattern_.find(seam.b).first], false,
            [&](Index i, Index j) { return (x[at(i)] - x[at(j)]).norm(); });
      if (seam.buttons == 0) {
        std::vector<std::array<Index, 2>>& pairs = garment_.closures.emplace_back();
        for (std::size_t k = 0; k < a.size(); ++k) pairs.push_back({a[k], b[k]});
      }
      const std::size_t last = a.size() - 1;
      const auto length_of = [this](const std::string& edge) {
        const std::vector<double> lengths = band_along(edge).lengths;
        return std::accumulate(lengths.begin(), lengths.end(), 0.0);
      };
      // As for other seams, the length is the mean length of both edges.
      const double length = 0.5 * (length_of(seam.a) + length_of(seam.b));
      // An end that both edges share, as at a sewn corner, needs no tie.
      const std::size_t skip_first = a.front() == b.front() ? 1 : 0;
      const std::size_t skipped = skip_first + (a.back() == b.back() ? 1 : 0);
      // If both edges are closed, the first and last entry of each is the same particle, which gets only one tie.
      const bool ring = last > 0 && skipped == 0 && a.front() == a.back() && b.front() == b.back();
      const std::size_t places = ring ? last : std::max(a.size(), skipped) - skipped;
      // At most one tie per pair of particles, even if there are more buttons.
      const std::size_t count = seam.buttons > 0 ? std::min(places, static_cast<std::size_t>(seam.buttons)) : places;
      const std::size_t gaps = ring ? count : count + skipped - 1;
      // All ties hold equal lengths of the seam. A shared end holds half of such a length, because the seam is on one
      // side of it only.
      const double tie_length = length / (static_cast<double>(count) + 0.5 * static_cast<double>(skipped));
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = count == 1 && skipped == 0 ? last / 2 : (2 * (i + skip_first) * last + gaps) / (2 * gaps);
        mesh::Tie tie{.a = a[k], .b = b[k], .strength = seam.strength};
        if (seam.tearing_load) {
          tie.strength = *seam.tearing_load * tie_length;
          tie.tearing = static_cast<int>(garment_.sheet.tearing_seams.size()) - 1;
        }
        if (seam.open) tie.open = *seam.open;
        if (seam.closed) tie.closed = *seam.closed;
        // Two edges can share inner particles too, which need no tie.
        if (tie.a != tie.b) garment_.sheet.ties.push_back(tie);
      }
    }
  }

  void check() const {
    for (std::size_t t = 0; t < garment_.sheet.triangles.size(); ++t)
      if (!(mesh::rest_area(garment_.sheet, t) > 1e-6 * spacing_ * spacing_))
        refuse(fmt::format("panel {}: expected an outline that {} m long edges follow, got a triangle without area",
                           pattern_.panels[at(garment_.panel_of[t])].name, spacing_));
  }

  const Pattern& pattern_;
  double spacing_;
  const std::string& where_;
  const Wearer* wearer_;                    // null if panels start flat
  std::vector<std::vector<int>> segments_;  // number of segments, per panel and edge
  std::vector<FlatMesh> meshes_;            // mesh of each panel
  std::vector<Index> first_point_;          // number of the first point of each panel
  Index point_count_ = 0, vertex_count_ = 0;
  DisjointSets sewn_together_{0};
  std::vector<Index> vertex_of_point_;  // vertex of each point
  Garment garment_;
};

}  // namespace

FlatMesh mesh_of(const Panel& panel, const std::vector<int>& segments, double spacing) {
  std::vector<Vec2> outline;
  for (std::size_t e = 0; e < panel.edges.size(); ++e) {
    const Arclength along(panel.edges[e].curves);
    for (int k = 0; k < segments[e]; ++k) outline.push_back(along.at(double(k) / segments[e]));
  }
  const double grain = panel.grain * std::numbers::pi / 180;
  return mesh_panel(outline, {-std::sin(grain), std::cos(grain)}, spacing);
}

Garment sew(const Pattern& pattern, double spacing, const std::string& where, const Wearer* wearer) {
  return Sewing(pattern, spacing, where, pattern.has_bent_panels() ? wearer : nullptr).sew();
}

}  // namespace weft::garment
