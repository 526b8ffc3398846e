// What follows a character: pins of cloth, and obstacles and cameras that a part of it carries.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "environment/environment.hpp"

namespace weft::environment {

/// An obstacle or camera that follows a part of a character.
struct PartFollower {
  bool camera = false;
  std::size_t number = 0;  ///< of the obstacle or camera
  std::size_t first = 0;   ///< of its four points among all that follow the character
};

struct Followers {
  std::vector<FollowingPin> points;        ///< of the pins, then of the others: a frame on the skin
  std::vector<BodyObject::Follower> pins;  ///< first_vertex: counted from the first point
  std::vector<PartFollower> rigid;
};

Followers followers_of(const scene::Scene& scene, const std::vector<ClothObject>& cloths, const std::string& character);

}  // namespace weft::environment
