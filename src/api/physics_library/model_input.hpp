// Checks a public model and converts it to a model of the physics.
#pragma once

#include <string>
#include <vector>
#include <weft/model.hpp>

#include "physics/model/model.hpp"

namespace weft::library {

/// Converts a pose. If a coordinate is not within ±1e5 m, or if the rotation is not a unit
/// quaternion, throws std::invalid_argument with the name `object`.
motion::Pose pose_of(const Pose& given, const std::string& object);

/// These functions convert gravity [m/s²] and wind [m/s]. If a component is not within ±1e5 m/s² or
/// ±1000 m/s, they throw std::invalid_argument with the name `object`.
Vec3 gravity_of(const Vector& given, const std::string& object);
Vec3 wind_of(const Vector& given, const std::string& object);

/// Converts a model. `driven`: names of the bodies that the caller will move by simulation::Simulation::drive();
/// Simulation::Impl checks that there are such bodies. If a value, a name, a reference or a mesh is not valid, throws
/// std::invalid_argument with the name of the object.
model::Model physics_of(const Model& given, const std::vector<std::string>& driven);

}  // namespace weft::library
