// Converts the public model to that of the physics.
#pragma once

#include <string>
#include <vector>
#include <weft/model.hpp>

#include "physics/model/model.hpp"

namespace weft::library {

/// Converts a pose. Throws std::invalid_argument that names `object` if a coordinate is not finite or beyond ±1e5 m, or
/// the rotation is no unit quaternion.
motion::Pose pose_of(const Pose& given, const std::string& object);

/// Gravity [m/s²] and wind [m/s]. Throw std::invalid_argument that names `object` if a component is out of range.
Vec3 gravity_of(const Vector& given, const std::string& object);
Vec3 wind_of(const Vector& given, const std::string& object);

/// Converts a model. `driven`: names of the bodies that the caller will move by Simulation::drive(). Throws
/// std::invalid_argument that names the object and what is wrong: a value, a name, a reference, or a mesh.
model::Model physics_of(const Model& given, const std::vector<std::string>& driven);

}  // namespace weft::library
