// Lists what follows a character: pins of cloth, and obstacles and cameras attached to one of its parts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "film/environment/actor.hpp"
#include "film/scene/scene.hpp"
#include "physics/model/model.hpp"

namespace weft::environment {

/// An obstacle or camera that follows a part of a character.
struct PartFollower {
  bool camera = false;     ///< whether the follower is a camera; else it is an obstacle
  std::size_t number = 0;  ///< index of the obstacle or camera in the scene
  std::size_t first = 0;   ///< index of the first of its four points among all points that follow the character
};

/// A pin that follows a character or a part of one.
struct PinFollower {
  std::size_t cloth = 0, pin = 0;  ///< index of the cloth; index of the pin among those of the cloth
  std::size_t first = 0;  ///< index of the point of its first particle among all points that follow the character
};

/// What follows one character.
struct Followers {
  std::vector<FollowerPoints> points;  ///< one per pin, then one per obstacle or camera, of four points (parents.hpp)
  std::vector<PinFollower> pins;
  std::vector<PartFollower> rigid;
};

/// Lists the followers of the character with the name `character`. `cloths`: those of the model, in the order of the
/// scene.
Followers followers_of(const scene::Scene& scene, const std::vector<model::Cloth>& cloths,
                       const std::string& character);

}  // namespace weft::environment
