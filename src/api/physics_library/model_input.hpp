// Converts the public model to that of the physics.
#pragma once

#include <string>
#include <vector>
#include <weft/model.hpp>

#include "physics/model/model.hpp"

namespace weft::library {

/// Throws std::invalid_argument that names the object if the position is not finite or the rotation no unit quaternion.
motion::Pose pose_of(const Pose& given, const std::string& object);

/// Throws std::invalid_argument that names the object and the value. `driven`: bodies that count as moving.
model::Model physics_of(const Model& given, const std::vector<std::string>& driven);

}  // namespace weft::library
