#include "film/garment/specification_panels.hpp"

#include <fmt/format.h>

#include "film/garment/outline.hpp"
#include "film/garment/triangulation.hpp"

namespace weft::garment {
namespace {

constexpr int kPointsPerSpecCurve = 8;

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
