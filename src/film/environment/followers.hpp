// The followers of a character: pins of cloth, and obstacles and cameras attached to a part of it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "film/environment/acting.hpp"
#include "film/scene/scene.hpp"
#include "physics/model/model.hpp"

namespace weft::environment {

/// An obstacle or camera that follows a part of a character.
struct PartFollower {
  bool camera = false;
  std::size_t number = 0;  ///< number of the obstacle or camera
  std::size_t first = 0;   ///< index of the first of its four points among all points that follow the character
};

/// A pin that follows a character.
struct PinFollower {
  std::size_t cloth = 0, pin = 0;
  std::size_t first = 0;  ///< index of the point of its first particle among all points that follow the character
};

struct Followers {
  std::vector<FollowingPin> points;  ///< of the pins, then four points for each obstacle or camera (see kFrameAxis)
  std::vector<PinFollower> pins;
  std::vector<PartFollower> rigid;
};

Followers followers_of(const scene::Scene& scene, const std::vector<model::Cloth>& cloths,
                       const std::string& character);

}  // namespace weft::environment
