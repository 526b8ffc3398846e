// Functions that derive from a model: parameters of the step loop, the start state, and which dynamic bodies keys hold.
#pragma once

#include <optional>
#include <vector>

#include "physics/integrator/step_control.hpp"
#include "physics/integrator/stepper.hpp"
#include "physics/model/model.hpp"
#include "physics/simulation/cloth_system.hpp"
#include "physics/simulation/collision_stage.hpp"

namespace weft::simulation {

/// Parameters of Newton's method and of its linear solves.
integrator::NewtonParameters newton_of(const model::Model& model);
/// The step control; nothing if the model has a fixed step instead of a tolerance.
std::optional<integrator::StepControl> step_control_of(const model::Model& model);

/// First particle of each cloth.
std::vector<Index> first_particles(const ClothSystem& cloth);

/// Start state at time t [s]: positions and velocities of all particles as the model gives them.
SystemState start_of(const model::Model& model, const ClothSystem& cloth, double t);

/// For a step that ends at t [s]: appends the frame particles (mesh::RigidFrame) of dynamic bodies that are not yet
/// released at t, with the positions and velocities of their keys.
void hold_frames(const model::Model& model, const ClothSystem& cloth, double t,
                 std::vector<integrator::HeldParticle>& held);

/// Whether a dynamic body is released at a time in [t, t + h) [s], up to rounding. Then forces move
/// it in the whole step from t to t + h.
bool any_frame_is_released(const model::Model& model, double t, double h);

/// Sets the velocities of the frame particles of the bodies that are released in this step: those of their keys at t,
/// plus Dynamics::velocity and Dynamics::angular_velocity.
void release_frames(const model::Model& model, const ClothSystem& cloth, double t, double h, std::span<Vec3> v);

/// Whether all dynamic bodies that are released after t0 [s] are still held at t1 [s] and have no
/// motion.
bool frames_are_constant(const model::Model& model, double t0, double t1);

}  // namespace weft::simulation
