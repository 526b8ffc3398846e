#include "render/sky_map.hpp"

#include <algorithm>

#include "render/depth_raster.hpp"

namespace weft::render {
void draw_sky_map(std::span<const DrawnMesh> meshes, const SkyView& view, std::vector<SkyTexel>& map) {
  map.assign(static_cast<std::size_t>(kSkySize) * kSkySize, {});
  const Mat4 texture_from_world = texture_from_clip() * view.clip_from_world;
  std::vector<Eigen::Vector3f> places;  // x, y in texels; depth
  const auto write = [&](int at, bool covered, float depth, float, float) {
    SkyTexel& texel = map[static_cast<std::size_t>(at)];
    texel.highest = covered ? std::min(texel.highest, depth) : texel.highest;
    texel.lowest = covered ? std::max(texel.lowest, depth) : texel.lowest;
  };
  for (const DrawnMesh& mesh : meshes) {
    places.clear();
    for (const Vec3& position : mesh.positions) {
      const Vec3 at = (texture_from_world * position.homogeneous()).head<3>();
      places.push_back(at.cwiseProduct(Vec3(kSkySize, kSkySize, 1)).cast<float>());
    }
    for (const auto& [a, b, c] : mesh.triangles)
      fill_triangle(places[a], places[b], places[c], kSkySize, kSkySize, write);
  }
}

}  // namespace weft::render
