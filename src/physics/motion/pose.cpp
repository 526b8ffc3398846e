#include "physics/motion/pose.hpp"

namespace weft::motion {

std::optional<Vec3> change_of_angles(const Pose& from, const Pose& to) {
  // The identity rotation counts as angles of 0, even if it is not given as angles.
  const auto angles = [](const Pose& pose) {
    return !pose.angles && pose.rotation.coeffs() == Quat::Identity().coeffs() ? Vec3(Vec3::Zero()) : pose.angles;
  };
  const std::optional<Vec3> first = angles(from), last = angles(to);
  return first && last ? std::optional<Vec3>(*last - *first) : std::nullopt;
}

}  // namespace weft::motion
