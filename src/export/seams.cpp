#include "export/seams.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace weft::exporter {

CutSurface cut_at_seams(const frame::Surface& surface) {
  CutSurface cut;
  cut.triangles = surface.triangles;
  if (surface.paint_uv.empty()) {
    Index vertices = static_cast<Index>(surface.uv.size());
    for (const auto& t : surface.triangles)
      for (const Index v : t) vertices = std::max(vertices, v + 1);
    cut.vertex_of.resize(static_cast<std::size_t>(vertices));
    std::iota(cut.vertex_of.begin(), cut.vertex_of.end(), 0);
    cut.uv = surface.uv;
    return cut;
  }
  std::map<std::tuple<Index, double, double>, Index> places;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      Index& corner = cut.triangles[t][k];
      const Vec2& uv = surface.paint_uv[t][k];
      const auto [place, fresh] =
          places.try_emplace({corner, uv.x(), uv.y()}, static_cast<Index>(cut.vertex_of.size()));
      if (fresh) {
        cut.vertex_of.push_back(corner);
        cut.uv.push_back(uv);
      }
      corner = place->second;
    }
  return cut;
}

}  // namespace weft::exporter
