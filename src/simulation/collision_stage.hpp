// Brings cloths and obstacles of a scene before the collision engine, step by step.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "collision/engine.hpp"
#include "environment/environment.hpp"
#include "integrator/system.hpp"
#include "scene/scene.hpp"
#include "simulation/cloth_system.hpp"

namespace weft::simulation {

class CollisionStage {
 public:
  /// Whether anything in the scene can collide; else no stage is made.
  static bool needed(const scene::Scene& scene);

  /// Throws Error(scene_invalid) where surfaces touch or cross from the start: what begins apart is kept apart, and
  /// nothing else can be promised.
  CollisionStage(const scene::Scene& scene, const environment::Environment& environment, const ClothSystem& system);

  /// Before the solve: obstacles go from where they are at t to where they are at t + h; contacts are found for the
  /// particles as they are now and would be with unchanged velocity. Leaves the environment at t + h.
  void begin_step(environment::Environment& environment, const integrator::State& now,
                  std::span<const integrator::HeldParticle> held, double t, double h);

  collision::ContactSet& contacts() { return engine_.contacts(); }
  const collision::ContactSet& contacts() const { return engine_.contacts(); }

  /// Looks for pairs that would meet on the way to `next` and makes contacts of them: how many were new. If there are
  /// some, solving again lets the forces do what finish_step would do by moving particles.
  int adopt_failing(const integrator::State& next);

  /// After the solve: corrects positions and velocities of `next` so that nothing met anything. Empty if that worked,
  /// else which objects are stuck and where.
  std::optional<std::string> finish_step(double h, integrator::State& next);

  int proximities() const { return engine_.proximities(); }
  double min_distance() const { return engine_.min_distance(); }

 private:
  std::string describe(const collision::TrianglePair& pair) const;

  std::vector<std::string> names_;   // per body
  std::vector<std::size_t> rigids_;  // of the environment, those that collide
  std::size_t particles_;
  std::vector<Vec3> all_t0_, all_t1_;  // particles, then vertices of the obstacles
  std::vector<std::uint8_t> movable_;
  collision::Engine engine_;
};

}  // namespace weft::simulation
