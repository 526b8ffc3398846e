// Finds the character that wears a garment, and makes the garment::Wearer of its body.
#pragma once

#include <map>
#include <set>
#include <string>

#include "core/types.hpp"
#include "film/garment/wearer.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// The wearers of garments in a scene. Each is made when it is first needed.
class Wearers {
 public:
  explicit Wearers(const scene::Scene& scene) : scene_(scene) {}

  /// The wearer of a cloth. Throws Error(scene_invalid) that begins with `where` if there is no character, if the cloth
  /// names no wearer and there are several characters, or if the wearer lacks bones or the joints that define its axes.
  const garment::Wearer& of(const scene::Cloth& cloth, const std::string& where);
  /// The character with the name `name`, which must exist. Throws Error(scene_invalid) if it lacks bones, or has
  /// neither two UpperLeg joints nor two UpperArm joints.
  const garment::Wearer& of(const std::string& name, const std::string& where);
  /// The body from which a sheet hangs: the character with the name `name`, which must exist. If it lacks the joints
  /// that define its axes, its origin is below the middle of its bounding box, and its x axis is that of the world.
  /// Throws Error(scene_invalid) if it lacks bones.
  const garment::Wearer& carrier(const std::string& name, const std::string& where);
  /// offset_in_file() of the first character from whose file a cloth has an `object`; zero if there is none. The cloth
  /// moves with the body, so that it stays around it.
  Vec3 offset_in_file(const scene::Cloth& cloth);

 private:
  const scene::Scene& scene_;
  std::map<std::string, garment::Wearer> made_;
  std::map<std::string, Vec3> offsets_;  // by the name of the character
  std::set<std::string> without_axes_;   // characters that lack the joints that define their axes
};

}  // namespace weft::environment
