// What the steps of a scene are begun with: method, tolerances, and the state of the cloths.
#pragma once

#include <optional>
#include <vector>

#include "environment/environment.hpp"
#include "integrator/step_control.hpp"
#include "integrator/stepper.hpp"
#include "scene/scene.hpp"
#include "simulation/cloth_system.hpp"
#include "simulation/collision_stage.hpp"

namespace weft::simulation {

integrator::Method method_of(scene::Integrator integrator);
integrator::NewtonParameters newton_of(const scene::Scene& scene);
/// Of a scene that has a tolerance instead of a step.
std::optional<integrator::StepControl> step_control_of(const scene::Scene& scene);

/// First particle of each cloth.
std::vector<Index> first_particles(const ClothSystem& cloth);

/// Where cloths start, as fast as the scene says, at time t [s].
Moment start_of(const scene::Scene& scene, const environment::Environment& environment, const ClothSystem& cloth,
                double t);

/// Appends the frames of bodies that are not yet released at the end t [s] of a step, where keys have them then.
void hold_frames(const environment::Environment& environment, const ClothSystem& cloth, double t,
                 std::vector<integrator::HeldParticle>& held);

/// Gives frames that are released in the step from t over h [s] the velocities of their keys, and their own. Returns
/// whether there is one.
bool release_frames(const environment::Environment& environment, const ClothSystem& cloth, double t, double h,
                    std::span<Vec3> v);

/// Whether bodies that are not yet released stay where they are between these times [s], and none is released.
bool frames_stay(const environment::Environment& environment, double t0, double t1);

}  // namespace weft::simulation
