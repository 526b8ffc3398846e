#include "film/garment/specification_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "film/garment/outline.hpp"
#include "film/garment/triangulation.hpp"

namespace weft::garment {
namespace {

constexpr int kPointsPerSpecCurve = 8;
// Height of the widest section of the hips of a body, as a fraction of its height.
constexpr double kHipLevelRatio = 0.49;
// Panels whose widths add up to less than this fraction of a girth do not surround the body: an apron, for example.
constexpr double kMinRingRatio = 0.6;
// Distance between the heights at which widths are measured [m].
constexpr double kLevelDistance = 0.01;

// Sum of the widths of the panels around the trunk at a height in space [m]. Turned panels lie on others.
double ring_width(std::span<const SpecPanel> panels, double height) {
  double sum = 0;
  for (const SpecPanel& panel : panels) {
    if (panel.around != Around::torso || panel.turned) continue;
    std::vector<Vec3> outline, cuts;
    for (const auto& points : panel.points)
      for (const Vec2& p : points) outline.push_back(panel.in_space(p));
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
      if ((a.y() < height) != (b.y() < height)) cuts.emplace_back(a + (height - a.y()) / (b.y() - a.y()) * (b - a));
    }
    if (cuts.empty()) continue;
    // All cuts lie on a line. The one that is farthest from any point of the line is an end.
    const auto farthest = [&](const Vec3& from) -> Vec3 {
      return *std::ranges::max_element(cuts, {}, [&](const Vec3& x) { return (x - from).squaredNorm(); });
    };
    const Vec3 end = farthest(cuts[0]);
    sum += (farthest(end) - end).norm();
  }
  return sum;
}

// Length of the edges without a stitch in the upper halves of the panels around trunk and legs, if they are nearer to
// level than to upright [m].
double rim_length(std::span<const SpecPanel> panels, std::span<const SpecStitch> stitches) {
  double sum = 0;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const SpecPanel& panel = panels[p];
    if ((panel.around != Around::torso && !panel.is_leg()) || panel.turned) continue;
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      const auto is_here = [&](const SpecStitch& stitch) {
        return (stitch.panel[0] == p && stitch.edge[0] == e) || (stitch.panel[1] == p && stitch.edge[1] == e);
      };
      if (std::ranges::any_of(stitches, is_here)) continue;
      const Vec3 start = panel.in_space(panel.edges[e].start), end = panel.in_space(panel.edges[e].end);
      const double rise = std::abs(end.y() - start.y());
      if (0.5 * (start.y() + end.y()) < panel.middle.y() || 2 * rise * rise > (end - start).squaredNorm()) continue;
      Vec2 last = panel.edges[e].end;
      for (std::size_t k = panel.points[e].size(); k-- > 0; last = panel.points[e][k])
        sum += (panel.points[e][k] - last).norm();
    }
  }
  return sum;
}

}  // namespace

std::string path_of(const SpecPanel& panel, const Eigen::Affine2d& map) {
  std::string path;
  const bool flips = map.linear().determinant() < 0;
  const auto text = [&](const Vec2& p) {
    const Vec2 q = map * p;
    return fmt::format(" {} {}", q.x(), q.y());
  };
  for (const SpecEdge& edge : panel.edges) {
    if (!edge.has_length()) continue;
    if (path.empty()) path = "M" + text(edge.start);
    if (edge.radius > 0)
      path += fmt::format(" A {0} {0} 0 {1:d} {2:d}", edge.radius, edge.large_arc, edge.sweep != flips);
    else
      path += edge.control.empty() ? " L" : edge.control.size() == 1 ? " Q" : " C";
    for (const Vec2& p : edge.control) path += text(p);
    path += text(edge.end);
  }
  return path + " Z";
}

void derive_geometry(SpecPanel& panel) {
  std::vector<Vec2> around;
  for (const SpecEdge& edge : panel.edges) {
    auto& points = panel.points.emplace_back();
    SpecPanel alone;
    alone.edges = {edge, {edge.end, edge.start, {}, 0, false, false}};
    const ParsedPath path = edge.has_length() ? parse_path(path_of(alone, Eigen::Affine2d::Identity())) : ParsedPath{};
    for (std::size_t c = 0; c + 1 < path.outline.size(); ++c)  // without the closing line
      for (int k = 0; k < kPointsPerSpecCurve; ++k)
        points.push_back(path.outline[c].at(double(k) / kPointsPerSpecCurve));
    if (points.empty()) points.push_back(edge.start);
    around.insert(around.end(), points.begin(), points.end());
  }
  panel.mirrored = polygon_area(around) < 0;
  panel.area = std::abs(polygon_area(around));
  // Adding zero changes −0 to 0. Without this, the angle of a panel at the back (specification.cpp) would be −180°
  // instead of 180°.
  panel.outward = panel.rotation.col(2) * (panel.mirrored ? -1 : 1) + Vec3::Zero();
  Vec2 low = around[0], high = around[0];
  for (const Vec2& p : around) low = low.cwiseMin(p), high = high.cwiseMax(p);
  panel.middle = panel.in_space(0.5 * (low + high));
}

Measures limit_to_panels(const Measures& body, std::span<const SpecPanel> panels, std::span<const SpecStitch> stitches,
                         double floor) {
  Measures measures = body;
  const auto limit = [](std::optional<double>& girth, double width) {
    if (width > kMinRingRatio * *girth) girth = std::min(*girth, width);
  };
  const double waist = floor + kWaistHeightRatio * *body.height, neck = floor + kNeckHeightRatio * *body.height;
  double top = -std::numeric_limits<double>::infinity(), chest = 0;
  for (const SpecPanel& panel : panels)
    for (const auto& points : panel.points)
      for (const Vec2& p : points) top = std::max(top, panel.in_space(p).y());
  for (double height = waist; height < neck; height += kLevelDistance)
    chest = std::max(chest, ring_width(panels, height));
  limit(measures.hip, ring_width(panels, floor + kHipLevelRatio * *body.height));
  if (top > 0.5 * (waist + neck))
    limit(measures.chest, chest);
  else
    limit(measures.waist, rim_length(panels, stitches));
  return measures;
}

std::optional<std::size_t> find_turned_panels(std::span<SpecPanel> panels, std::span<const SpecStitch> stitches) {
  std::vector<int> turns(panels.size(),
                         -1);  // relative to the first panel of a connected set: 0 same side, 1 other, −1 unknown
  for (std::size_t first = 0; first < panels.size(); ++first) {
    if (turns[first] >= 0) continue;
    std::vector<std::size_t> together{first};
    turns[first] = 0;
    for (std::size_t next = 0; next < together.size(); ++next)
      for (std::size_t s = 0; s < stitches.size(); ++s)
        for (const std::size_t k : {0, 1}) {
          if (stitches[s].panel[k] != together[next]) continue;
          const std::size_t other = stitches[s].panel[1 - k];
          const int turn = turns[together[next]] ^ static_cast<int>(stitches[s].right_wrong);
          if (turns[other] < 0) turns[other] = turn, together.push_back(other);
          if (turns[other] != turn) return s;
        }
    std::array<double, 2> area{0, 0};
    for (const std::size_t p : together) area.at(static_cast<std::size_t>(turns[p])) += panels[p].area;
    const int turned = area[1] <= area[0] ? 1 : 0;
    for (const std::size_t p : together) panels[p].turned = turns[p] == turned;
  }
  return std::nullopt;
}

}  // namespace weft::garment
