// Rules that several tables of the scene format share.
#pragma once

#include <string>
#include <string_view>
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

// Documentation that several keys share.
inline constexpr std::string_view kBetweenKeys = "interpolation between the entries of `keys`; cubic is smooth";
inline constexpr std::string_view kWhetherItCollides =
    "whether it collides; false: cloth, ropes and bodies pass through it";
inline constexpr std::string_view kFrictionOfBoth =
    "Coulomb friction coefficient; a contact uses the geometric mean of the coefficients of both sides";
/// Documented default of a value that a key frame omits.
inline const std::string kDefaultOfKey = "as in the key before; in the first key, the value given beside `keys`";

/// Adds the row of the time of a key frame.
template <class Key>
void key_time_row(TableBuilder<Key>& rows) {
  rows.number("time", &Key::time, kTimeRange, "s", "time of the scene; later than that of the key before")
      .need(Need::required);
}

// A fan, camera or light has at least one key frame. The first one stores the values that its table gives directly.

/// Returns a function that returns a member of the first key frame.
template <class Key, class Field>
auto of_first_key(Field Key::*field) {
  return [field](auto& owner) -> Field& { return owner.keys.front().*field; };
}
/// Appends entry i of `keys` with its defaults, which are the values of the entry before. Entry 0 already exists.
template <class S>
void copy_key_before(S& owner, std::size_t i) {
  if (i == 0) return;
  const auto last = owner.keys.back();
  owner.keys.push_back(last);
}
template <class S>
bool moves(S& owner) {
  return owner.keys.size() > 1;
}
template <class S>
bool stands_still(S& owner) {
  return owner.keys.size() == 1;
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

}  // namespace weft::scene
