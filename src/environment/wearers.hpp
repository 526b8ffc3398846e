// Which character wears a garment, and its body for that.
#pragma once

#include <map>
#include <string>

#include "garment/wearer.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// The bodies of a scene that garments are put on, each made when it is first asked for.
class Wearers {
 public:
  explicit Wearers(const scene::Scene& scene) : scene_(scene) {}

  /// Throws Error(scene_invalid) after `where` if the cloth names no wearer and there is not just one character, or if
  /// that has no bones.
  const garment::Wearer& of(const scene::Cloth& cloth, const std::string& where);

 private:
  const scene::Scene& scene_;
  std::map<std::string, garment::Wearer> made_;
};

}  // namespace weft::environment
