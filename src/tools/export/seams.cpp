#include "tools/export/seams.hpp"

#include <algorithm>
#include <numeric>

namespace weft::exporter {
namespace {

struct Place {
  Vec2 uv{0, 0}, picture_uv{0, 0};
  bool operator==(const Place&) const = default;
};

/// The places of each vertex; the first one has the index of the vertex.
class Places {
 public:
  explicit Places(std::size_t vertices) : places_(vertices), next_(vertices, kNone), taken_(vertices, 0) {}

  /// Returns the index of the place. If the vertex gets an additional place, appends the vertex to `vertex_of`.
  Index of(Index vertex, const Place& place, std::vector<Index>& vertex_of) {
    Index at = vertex;
    if (taken_[index(at)] == 0) {
      taken_[index(at)] = 1;
      places_[index(at)] = place;
      return at;
    }
    while (!(places_[index(at)] == place)) {
      if (next_[index(at)] == kNone) {
        next_[index(at)] = static_cast<Index>(places_.size());
        places_.push_back(place);
        next_.push_back(kNone);
        vertex_of.push_back(vertex);
        return static_cast<Index>(places_.size() - 1);
      }
      at = next_[index(at)];
    }
    return at;
  }

  const std::vector<Place>& all() const { return places_; }

 private:
  static constexpr Index kNone = -1;
  static std::size_t index(Index i) { return static_cast<std::size_t>(i); }
  std::vector<Place> places_;
  std::vector<Index> next_;  // next place of the same vertex
  std::vector<char> taken_;  // whether the first place is set, per vertex
};

// Whether picture coordinates differ from `uv` for any material, so that they must be written separately.
bool needs_own_coordinates(const Materials& materials) {
  return std::ranges::any_of(materials.all, [](const Material& material) {
    return material.has_picture() && material.picture_from_uv != Eigen::Matrix<double, 2, 3>::Identity();
  });
}

}  // namespace

CutSurface cut_at_seams(const frame::Surface& surface, const Materials& materials, std::size_t vertices) {
  CutSurface cut;
  cut.triangles = surface.triangles;
  cut.vertex_of.resize(vertices);
  std::iota(cut.vertex_of.begin(), cut.vertex_of.end(), 0);
  const bool by_corner = !surface.paint_uv.empty();
  if (!by_corner && surface.uv.empty()) return cut;
  const bool own = needs_own_coordinates(materials);
  Places places(vertices);
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const Material& material = materials.all[materials.of_triangle(surface, t)];
    for (std::size_t k = 0; k < 3; ++k) {
      Index& corner = cut.triangles[t][k];
      Place place{by_corner ? surface.paint_uv[t][k] : surface.uv[static_cast<std::size_t>(corner)]};
      if (own)
        place.picture_uv = material.has_picture() ? Vec2(material.picture_from_uv * place.uv.homogeneous()) : place.uv;
      corner = places.of(corner, place, cut.vertex_of);
    }
  }
  for (const Place& place : places.all()) {
    cut.uv.push_back(place.uv);
    if (own) cut.picture_uv.push_back(place.picture_uv);
  }
  return cut;
}

}  // namespace weft::exporter
