#include "film/environment/hanging.hpp"

#include <algorithm>
#include <cmath>

namespace weft::environment {

std::string carrier_of(const scene::Scene& scene, const scene::Cloth& cloth) {
  for (const scene::Pin& pin : cloth.pins) {
    const scene::Followed followed = scene::followed(pin.follow);
    const auto found = std::ranges::find(scene.characters, followed.body, &scene::Character::name);
    if (!followed.part.empty() && found != scene.characters.end() && scene::skeleton_motion_of(*found) != nullptr)
      return followed.body;
  }
  return {};
}

double move_off_carrier(const scene::Cloth& cloth, const garment::Wearer& carrier, std::span<Vec3> start) {
  const Eigen::Isometry3d sheet = Eigen::Translation3d(cloth.pose.position) * cloth.pose.rotation;
  const double side = (sheet.inverse() * carrier.to_world.translation()).z() > 0 ? -1 : 1;
  const Eigen::Isometry3d to_sheet = sheet.inverse() * carrier.to_world;
  const Vec2 half = 0.5 * cloth.size;
  double distance = 0;
  for (const Vec3& x : carrier.skin) {
    const Vec3 in_sheet = to_sheet * x;
    if (std::abs(in_sheet.x()) > half.x() || std::abs(in_sheet.y()) > half.y()) continue;
    distance = std::max(distance, side * in_sheet.z());
  }
  if (distance == 0) return 0;
  distance += cloth.material.thickness;
  for (Vec3& x : start) x += side * distance * sheet.linear().col(2);
  return distance;
}

}  // namespace weft::environment
