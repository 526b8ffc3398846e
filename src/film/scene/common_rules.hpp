// Rules that several tables of the scene format share.
#pragma once

#include <string>
#include <vector>

#include "film/scene/rule.hpp"
#include "film/scene/table_builder.hpp"

namespace weft::scene {

inline const Range kPositionRange = within(-1e5, 1e5);  // coordinates [m]
inline const Range kSizeRange = above(0, 1e4);          // sizes [m]
inline const Range kTimeRange = within(-1e5, 1e5);      // times [s]
inline const std::vector<std::string> kXyz = {"x", "y", "z"};
inline const std::vector<std::string> kWeftWarp = {"weft", "warp"};
inline const std::vector<std::string> kInterpolations = {"linear", "cubic"};

// Default colours (sRGB). The floor reflects 0.4 of the light, so that both darker and brighter objects contrast with
// it.
inline const Vec3 kClothColor(0.60, 0.27, 0.22), kObstacleColor(0.76, 0.72, 0.65), kFloorColor(0.66, 0.66, 0.65);
inline Look look_of(const Vec3& color) {
  Look look;
  look.color = color;
  return look;
}

inline Look rope_look() {
  Look look = look_of(Vec3(0.80, 0.72, 0.56));
  look.roughness = 0.85;
  return look;
}

/// Rotation about the fixed x axis, then the y axis, then the z axis, by these angles [degrees].
Quat from_angles(const Vec3& degrees);

/// Adds the rows of the rotation of a pose. `otherwise`: documentation of the default.
template <class S, class Member>
void rotation_rows(TableBuilder<S>& rows, Member pose, const std::string& otherwise) {
  const auto of = [pose](S& s) -> Pose& { return std::invoke(pose, s); };
  rows.vector(
          "quaternion", [of](S& s) -> Quat& { return of(s).rotation; }, {"w", "x", "y", "z"}, within(-1e3, 1e3), "",
          "rotation as a quaternion of any length but 0")
      .nonzero()
      .by_default(otherwise)
      .written_if([of](S& s) { return !of(s).angles; })
      .when_given([of](S& s) { of(s).angles.reset(); });
  rows.vector(
          "rotation", [of](S& s) -> std::optional<Vec3>& { return of(s).angles; }, {"rx", "ry", "rz"},
          within(-36000, 36000), "degrees",
          "rotation about the fixed x, then y, then z axis; if one angle alone changes between two keys, it turns by "
          "its whole change, full turns included; if several change, the object turns the shortest way")
      .excludes("quaternion")
      .when_given([of](S& s) { of(s).rotation = from_angles(*of(s).angles); });
}

/// Adds the rows of position and rotation of a pose. `position_of`: documentation of the position; `otherwise`:
/// documentation of the default.
template <class S, class Member>
void pose_rows(TableBuilder<S>& rows, Member pose, const std::string& position_of, const std::string& otherwise = {}) {
  rows.vector(
          "position", [pose](S& s) -> Vec3& { return std::invoke(pose, s).position; }, kXyz, kPositionRange, "m",
          position_of)
      .by_default(otherwise);
  rotation_rows(rows, pose, otherwise);
}

/// Rules for the look of an obstacle, and for that of a character.
const Table& obstacle_look_rules();
const Table& character_look_rules();

/// Documented default of a value that a key frame omits.
inline const std::string kDefaultOfKey = "as in the key before; in the first key, the value given beside `keys`";

}  // namespace weft::scene
