#include "film/garment/wrapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "core/near_points.hpp"
#include "film/garment/least_squares_positions.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::garment {
namespace {

// The lengths below are for people: they are multiplied by size_factor().
//
// Additional width of a ring of panels with a closure or a slit [m], so that the two edges of the opening start apart.
constexpr double kOpeningSlack = 0.03;
// kMinSleeveGap: minimum distance of sleeves from the skin at the start [m]. kCapNarrowing: the cap of a sleeve begins
// where its ring is narrower than farther down the arm by more than this [m].
constexpr double kMinSleeveGap = 0.006, kCapNarrowing = 0.01;
// Number of sample intervals along a seam, and of iterations, to find the position of a panel from its seams.
constexpr int kSeamPoints = 16, kSeamRounds = 6;
// Distance over which closing a seam bends panels [m]. With a smaller distance, sleeves are creased at the cap; with a
// larger one, they are not centred on the axis of the arm.
constexpr double kBendingDistance = 0.1;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// Coordinates of the point `p` of a panel on the tube of its part: length across and height [m], seen from outside.
/// `position`: start position of the panel's origin.
Vec2 unrolled_position(const Panel& panel, const Vec2& position, const Vec2& p) {
  const Vec2 turned = Eigen::Rotation2Dd(radians(panel.rotation)) * Vec2(panel.scale.cwiseProduct(p));
  const Vec2 q = position + turned;
  return {panel.side == Side::back ? -q.x() : q.x(), q.y()};
}

/// Finds the positions of panels on tubes, and bends the panels around them.
class PanelPlacer {
 public:
  /// `refuse` receives the description of a mistake and must throw.
  PanelPlacer(const Pattern& pattern, std::span<const FlatMesh> meshes, const Wearer& wearer,
              const std::function<void(const std::string&)>& refuse)
      : size_(size_factor(wearer)), pattern_(pattern), meshes_(meshes), positions_(pattern.panels.size()) {
    for (const Panel& panel : pattern.panels) {
      try {
        if (!tubes_.contains(part_of(panel))) tubes_.emplace(part_of(panel), Tube(wearer, part_of(panel)));
      } catch (const Error& error) {
        refuse(fmt::format("panel {}: {}", panel.name, error.what()));
      }
    }
  }

  /// Sets the positions of all panels: first those that the pattern states, then the others from seams. Returns the
  /// first panel whose position remains unknown, or null.
  const Panel* find_positions() {
    for (std::size_t p = 0; p < positions_.size(); ++p) positions_[p] = pattern_.panels[p].position;
    update_eases();
    for (bool found = true; found;) {
      // Each round uses only positions of the previous round, so that mirror images get mirrored positions.
      std::vector<std::optional<Vec2>> next = positions_;
      for (std::size_t p = 0; p < positions_.size(); ++p)
        if (!positions_[p]) next[p] = position_from_seams(p);
      found = next != positions_;
      positions_ = std::move(next);
    }
    update_eases();
    for (std::size_t p = 0; p < positions_.size(); ++p)
      if (!positions_[p]) return &pattern_.panels[p];
    return nullptr;
  }

  std::vector<Vec3> bent_points(std::size_t p) const {
    std::vector<Vec3> points;
    for (const Vec2& point : meshes_[p].points) points.push_back(place(p, *positions_[p], point));
    return points;
  }

 private:
  static Around part_of(const Panel& panel) { return panel.around == Around::none ? Around::torso : panel.around; }
  static double angle_of(const Panel& panel) {
    if (panel.angle) return radians(*panel.angle);
    if (panel.side) return *panel.side == Side::back ? std::numbers::pi : 0;
    const bool left = panel.around == Around::left_arm, right = panel.around == Around::right_arm;
    return left ? 0.5 * std::numbers::pi : right ? -0.5 * std::numbers::pi : 0;
  }

  Vec3 place(std::size_t p, const Vec2& position, const Vec2& point) const {
    const Panel& panel = pattern_.panels[p];
    const Vec2 q = unrolled_position(panel, position, point);
    return tubes_.at(part_of(panel)).at(q.y(), angle_of(panel), q.x(), outward(panel, q.y()));
  }
  double outward(const Panel& panel, double s) const {
    double ease = 0;
    if (const auto found = eases_.find(part_of(panel)); found != eases_.end()) {
      const auto& [first, of_height] = found->second;
      const double place = std::clamp((s - first) / step_, 0.0, static_cast<double>(of_height.size() - 1));
      const auto below = std::min(static_cast<std::size_t>(place), of_height.size() - 1);
      const double fraction = place - static_cast<double>(below);
      ease = (1 - fraction) * of_height[below] + fraction * of_height[std::min(below + 1, of_height.size() - 1)];
    }
    return pattern_.gap + kLayerDistance * panel.layer + ease;
  }

  // Width of the ring around each part [m]: the sum over its panels of layer 0, by height in steps of step_.
  std::map<Around, std::map<long, double>> widths() const {
    std::map<Around, std::map<long, double>> of_part;
    for (std::size_t p = 0; p < positions_.size(); ++p) {
      const Panel& panel = pattern_.panels[p];
      if (!positions_[p] || panel.layer > 0) continue;
      std::map<long, std::pair<double, double>> extents;
      for (const mesh::Triangle& t : meshes_[p].triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          Vec2 a = unrolled_position(panel, *positions_[p], meshes_[p].points[at(t[k])]);
          Vec2 b = unrolled_position(panel, *positions_[p], meshes_[p].points[at(t[(k + 1) % 3])]);
          if (a.y() > b.y()) std::swap(a, b);
          for (auto level = static_cast<long>(std::ceil(a.y() / step_)); level * step_ <= b.y() && b.y() > a.y();
               ++level) {
            const double x = a.x() + (level * step_ - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
            auto [entry, fresh] = extents.try_emplace(level, x, x);
            auto& [low, high] = entry->second;
            low = std::min(low, x), high = std::max(high, x);
          }
        }
      for (const auto& [level, extent] : extents) of_part[part_of(panel)][level] += extent.second - extent.first;
    }
    return of_part;
  }
  // Whether the ring around a part has a closure or a slit. A closure that joins panels of two parts, such as a fly,
  // belongs to no ring.
  bool has_opening(Around part) const {
    std::set<std::pair<std::size_t, std::size_t>> sewn;  // panels and their edges
    for (const Seam& seam : pattern_.seams) {
      const auto a = pattern_.find(seam.a), b = pattern_.find(seam.b);
      sewn.insert(a), sewn.insert(b);
      const bool around = part_of(pattern_.panels[a.first]) == part && part_of(pattern_.panels[b.first]) == part;
      if (seam.is_closure() && around) return true;
    }
    // An unsewn edge that continues a sewn edge without a corner is a slit.
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p) {
      const std::vector<PanelEdge>& edges = pattern_.panels[p].edges;
      for (std::size_t e = 0; e < edges.size() && part_of(pattern_.panels[p]) == part; ++e) {
        const std::size_t next = (e + 1) % edges.size();
        if (sewn.contains({p, e}) != sewn.contains({p, next}) &&
            !has_corner(edges[e].curves.back(), edges[next].curves.front()))
          return true;
      }
    }
    return false;
  }

  // Computes the ease of each ring: the distance by which its panels move outward so that the ring closes [m]. The ease
  // of narrow sleeves is negative: if they started farther out, closing their seams would pull them through the arm.
  void update_eases() {
    eases_.clear();
    for (const auto& [part, of_level] : widths()) {
      auto& [first, of_height] = eases_[part];
      first = step_ * static_cast<double>(of_level.begin()->first);
      const double slack = has_opening(part) ? kOpeningSlack * size_ : 0;
      const bool arm = is_arm(part);
      const double min_ease = arm ? std::min(kMinSleeveGap * size_ - pattern_.gap, 0.0) : 0;
      std::vector<double> raw;
      double widest = 0;
      for (const auto& [level, width] : of_level) {
        const double girth = tubes_.at(part).girth(step_ * static_cast<double>(level), pattern_.gap);
        const double ease = std::max(min_ease, (width + slack - girth) / (2 * std::numbers::pi));
        // The cap of a sleeve does not close around the arm. It gets the ease of the height step below.
        const double kept = arm && width < widest - kCapNarrowing * size_ ? raw.back() : ease;
        // In a gap between panels, uses the ease of the nearer panel.
        if (const auto index = static_cast<std::size_t>(level - of_level.begin()->first); index > raw.size()) {
          raw.resize((raw.size() + index) / 2, double(raw.back()));
          raw.resize(index, kept);
        }
        raw.push_back(kept);
        widest = std::max(widest, width);
      }
      // Smooths the ease over height, because the width jumps where a panel begins or ends.
      constexpr long kSmooth = 4;
      const auto count = static_cast<long>(raw.size());
      for (long i = 0; i < count; ++i) {
        double sum = 0;
        for (long k = i - kSmooth; k <= i + kSmooth; ++k)
          sum += raw[static_cast<std::size_t>(std::clamp(k, 0L, count - 1))];
        of_height.push_back(sum / (2 * kSmooth + 1));
      }
    }
  }

  // The position of panel p at which its seams to placed panels are shortest: along its part and, if all these panels
  // are around the same part, across too. Panels around arms, neck and head stay in the middle of their side, as drawn.
  std::optional<Vec2> position_from_seams(std::size_t p) const {
    struct Pair {
      Vec2 own;
      Vec3 other;
    };
    std::vector<Pair> pairs;
    const Around part = part_of(pattern_.panels[p]);
    bool moves_across = part == Around::torso || part == Around::body;
    for (const Seam& seam : pattern_.seams)
      for (const bool swapped : {false, true}) {
        const auto [own, edge] = pattern_.find(swapped ? seam.b : seam.a);
        const auto [other, other_edge] = pattern_.find(swapped ? seam.a : seam.b);
        if (own != p || other == p || !positions_[other]) continue;
        const Panel &panel = pattern_.panels[own], &neighbour = pattern_.panels[other];
        const Arclength along(panel.edges[edge].curves), beside(neighbour.edges[other_edge].curves);
        const bool reversed = are_drawn_from_same_side(panel, neighbour);
        moves_across = moves_across && part_of(neighbour) == part;
        for (int k = 0; k <= kSeamPoints; ++k) {
          const double fraction = double(k) / kSeamPoints;
          pairs.push_back(
              {along.at(fraction), place(other, *positions_[other], beside.at(reversed ? 1 - fraction : fraction))});
        }
      }
    if (pairs.empty()) return std::nullopt;
    const Tube& tube = tubes_.at(part);
    Vec2 position(0, tube.high());
    for (int round = 0; round < kSeamRounds; ++round) {
      constexpr double kAcrossStep = 1e-3;  // to find the direction across [m]
      double up = 0, across = 0;
      for (const Pair& pair : pairs) {
        const double s = unrolled_position(pattern_.panels[p], position, pair.own).y();
        const Vec3 here = place(p, position, pair.own), missing = pair.other - here;
        up += missing.dot(tube.along(s));
        if (moves_across)
          across += missing.dot((place(p, position + Vec2(kAcrossStep, 0), pair.own) - here).normalized());
      }
      position.y() += up / static_cast<double>(pairs.size());
      // In the first round, the height is not yet known, nor with it the section along which the panel moves.
      if (round > 0) position.x() += across / static_cast<double>(pairs.size());
    }
    return position;
  }

  const double size_;                 // size_factor() of the wearer
  const double step_ = 0.01 * size_;  // height step at which widths are measured [m]
  const Pattern& pattern_;
  std::span<const FlatMesh> meshes_;
  std::vector<std::optional<Vec2>> positions_;
  std::map<Around, Tube> tubes_;
  std::map<Around, std::pair<double, std::vector<double>>>
      eases_;  // by part: first height, and the ease at each height step [m]
};

}  // namespace

bool are_drawn_from_same_side(const Panel& a, const Panel& b) {
  return a.from_inside() == b.from_inside();
}

std::vector<std::vector<Vec3>> bend_around(const Pattern& pattern, std::span<const FlatMesh> meshes,
                                           const Wearer& wearer,
                                           const std::function<void(const std::string&)>& refuse) {
  PanelPlacer placer(pattern, meshes, wearer, refuse);
  if (const Panel* unplaced = placer.find_positions())
    refuse(
        fmt::format("panel {}: expected a position, or a seam to a panel that has one, got neither", unplaced->name));
  std::vector<std::vector<Vec3>> points;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) points.push_back(placer.bent_points(p));
  return points;
}

std::vector<Vec3> join_in_space(std::span<const mesh::Triangle> triangles, std::span<const std::array<Vec3, 3>> corners,
                                std::size_t vertices, double spacing, double size) {
  // With this weight, the effect of closing a seam decays over this distance.
  const double distance = kBendingDistance * size;
  LeastSquaresPositions<3> places(vertices, spacing * spacing / (distance * distance));
  for (std::size_t t = 0; t < triangles.size(); ++t) places.add(triangles[t], corners[t]);
  return places.solve();
}

void move_out_of_skin(const Wearer& wearer, std::span<const mesh::Triangle> triangles, double clearance,
                      std::span<Vec3> x) {
  constexpr double kMaxSkinDepth = 0.08;  // maximum depth inside the skin of a person [m]
  constexpr int kRounds = 30, kRings = 3;
  const double radius = kMaxSkinDepth * size_factor(wearer);
  NearPoints skin(radius);
  for (const Vec3& place : wearer.skin) skin.add(place);
  std::vector<Vec3> normals(wearer.skin.size());
  mesh::vertex_normals(wearer.triangles, wearer.skin, normals);
  std::vector<std::vector<Index>> neighbours(x.size());
  std::vector<char> rim(x.size(), 0);
  const std::vector<mesh::Triangle> all(triangles.begin(), triangles.end());
  const mesh::EdgeSet edges = mesh::collect_edges(all);
  for (const mesh::Edge& edge : edges.edges)
    if (edge.triangles[1] < 0) rim[at(edge.vertices[0])] = rim[at(edge.vertices[1])] = 1;
  for (const mesh::Edge& edge : edges.edges) {
    const auto [a, b] = edge.vertices;
    // A vertex on the rim is smoothed only along the rim. Inner vertices therefore do not count as its neighbours.
    if (!rim[at(a)] || edge.triangles[1] < 0) neighbours[at(a)].push_back(b);
    if (!rim[at(b)] || edge.triangles[1] < 0) neighbours[at(b)].push_back(a);
  }
  std::vector<char> moving(x.size(), 0);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t v = 0; v < x.size(); ++v) {
      const NearPoints::Nearest near = skin.nearest(x[v]);
      if (!(near.distance_sq < radius * radius)) continue;
      const Vec3& normal = normals[at(near.point)];
      const double missing = clearance - (x[v] - wearer.skin[at(near.point)]).dot(normal);
      if (missing <= 0) continue;
      x[v] += missing * normal;
      moving[v] = 1;
    }
    if (std::ranges::none_of(moving, [](char m) { return m != 0; }) || round + 1 == kRounds) break;
    if (round == 0)
      for (int ring = 0; ring < kRings; ++ring) {
        const std::vector<char> before = moving;
        for (std::size_t v = 0; v < x.size(); ++v)
          for (const Index n : neighbours[v]) moving[v] |= before[at(n)];
      }
    smooth(neighbours, moving, x);
  }
}

}  // namespace weft::garment
