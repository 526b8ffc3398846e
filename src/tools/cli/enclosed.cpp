#include "tools/cli/enclosed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace weft::cli {
namespace {

/// Winding number of a surface around p: sum of the solid angles of its triangles (Van Oosterom and Strackee, 1983, eq.
/// 8), divided by 4π. It is ±1 inside a closed surface, 0 outside, and a fraction if the surface is open.
double winding_number(const frame::Surface& surface, const std::vector<Vec3>& positions, const Vec3& p) {
  double sum = 0;
  for (const auto& triangle : surface.triangles) {
    const Vec3 a = positions[static_cast<std::size_t>(triangle[0])] - p,
               b = positions[static_cast<std::size_t>(triangle[1])] - p,
               c = positions[static_cast<std::size_t>(triangle[2])] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

/// Whether the cloth is inside the surface. Tests only three particles, since cloth that is partly inside crosses the
/// surface, and the simulation refuses such a start.
bool is_inside(const std::vector<Vec3>& cloth, const frame::Surface& surface, const std::vector<Vec3>& positions) {
  constexpr double kSlack = 1e-6;  // rounding error of the sum over a million triangles
  const std::size_t last = cloth.size() - 1;
  return std::ranges::all_of(std::array{std::size_t{0}, last / 2, last}, [&](std::size_t particle) {
    return std::abs(std::abs(winding_number(surface, positions, cloth[particle])) - 1) < kSlack;
  });
}

}  // namespace

std::vector<std::string> find_enclosed(const scene::Scene& scene, const frame::FrameSnapshot& snapshot) {
  const auto collides = [&](const std::string& name) {
    const auto found = std::ranges::find(scene.obstacles, name, &scene::Obstacle::name);
    return found != scene.obstacles.end() && found->collide;
  };
  std::vector<std::string> found;
  for (std::size_t c = 0; c < snapshot.surfaces.size(); ++c) {
    if (snapshot.surfaces[c]->kind != frame::ObjectKind::cloth || snapshot.states[c].positions.empty()) continue;
    for (std::size_t o = 0; o < snapshot.surfaces.size(); ++o) {
      const frame::Surface& body = *snapshot.surfaces[o];
      if (body.kind == frame::ObjectKind::obstacle && collides(body.name) &&
          is_inside(snapshot.states[c].positions, body, snapshot.states[o].positions))
        found.push_back(fmt::format("cloth.{}: starts wholly inside obstacle.{}, and stays there; place it outside",
                                    snapshot.surfaces[c]->name, body.name));
    }
  }
  return found;
}

}  // namespace weft::cli
