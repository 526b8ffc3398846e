// What the step loop derives from a model: parameters, the state at the start, and which bodies keys hold.
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

/// For a step that ends at t [s]: appends the frame particles (mesh::RigidFrame) of bodies that keys still hold at t,
/// with the positions and velocities that the keys give.
void hold_frames(const model::Model& model, const ClothSystem& cloth, double t,
                 std::vector<integrator::HeldParticle>& held);

/// Whether a body is released in the step from t to t + h [s].
bool any_frame_is_released(const model::Model& model, double t, double h);

/// Sets the velocities of the frame particles of the bodies that are released in this step: the velocities of their
/// keys at t, plus the body's own velocity and spin.
void release_frames(const model::Model& model, const ClothSystem& cloth, double t, double h, std::span<Vec3> v);

/// Whether all dynamic bodies that keys hold at t0 [s] stay held and still until t1 [s].
bool frames_are_constant(const model::Model& model, double t0, double t1);

}  // namespace weft::simulation
