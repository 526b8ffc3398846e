// How the steps of a run begin: method, tolerances, and the state at the start.
#pragma once

#include <optional>
#include <vector>

#include "physics/integrator/step_control.hpp"
#include "physics/integrator/stepper.hpp"
#include "physics/model/model.hpp"
#include "physics/simulation/cloth_system.hpp"
#include "physics/simulation/collision_stage.hpp"

namespace weft::simulation {

integrator::NewtonParameters newton_of(const model::Model& model);
/// None if the model has a fixed step instead of a tolerance.
std::optional<integrator::StepControl> step_control_of(const model::Model& model);

/// First particle of each cloth.
std::vector<Index> first_particles(const ClothSystem& cloth);

/// Positions of all particles at the start, and their velocities as the model gives them, at time t [s].
SystemState start_of(const model::Model& model, const ClothSystem& cloth, double t);

/// For a step that ends at t [s]: appends the frame particles of bodies that keys still move at t, with the positions
/// and velocities that the keys give.
void hold_frames(const model::Model& model, const ClothSystem& cloth, double t,
                 std::vector<integrator::HeldParticle>& held);

/// Sets the velocities of frames that are released in the step from t to t + h [s] to those of their keys at t plus the
/// body's own velocity and spin. Returns whether there are any.
bool release_frames(const model::Model& model, const ClothSystem& cloth, double t, double h, std::span<Vec3> v);

/// Whether keys neither move nor release, between t0 and t1 [s], any body that they hold at t0.
bool frames_are_constant(const model::Model& model, double t0, double t1);

}  // namespace weft::simulation
