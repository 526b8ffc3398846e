// Brings cloths and obstacles of a scene before the collision engine, step by step.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
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

  collision::ContactResponse& response() { return engine_.response(); }
  const collision::ContactResponse& response() const { return engine_.response(); }

  /// Appends what the velocity constraints hold of the particles that no pin holds.
  void append_constraints(std::vector<integrator::HeldParticle>& held) const;
  /// After a solve that led to `next`: see ContactResponse::revise.
  int revise(const integrator::State& next, const collision::VelocityConstraints::ForceOn& force_on) {
    return engine_.response().revise(all_t0_, next.x, force_on);
  }

  /// After the solve: whether nothing meets anything on the way to `next`.
  bool apart(const integrator::State& next);

  /// Where apart() said no: makes contacts of the pairs that would meet, and says how many were new. If there are some,
  /// solving again lets the forces do what push_apart would do by moving particles.
  int adopt_failing() { return engine_.adopt_failing(all_t0_, all_t1_); }

  /// Corrects positions and velocities of `next` so that nothing meets anything, except cloth and the obstacles that
  /// leave it no room; these are then pinched. Without `may_pinch` no cloth becomes pinched by an obstacle that did not
  /// pinch it before. Empty if that worked, else which objects are stuck and where.
  std::optional<std::string> push_apart(double h, bool may_pinch, integrator::State& next);

  /// What a frame has pinched, from its steps so far; the next call tells of the next frame.
  struct Pinches {
    int pairs = 0;                   ///< most triangles at once that are given up to obstacles
    std::vector<std::string> begun;  ///< those not in the frame before, by object: "'a' has no room between ..."
  };
  Pinches take_pinches();

  /// Before a frame: see Engine::forget.
  void forget() { engine_.forget(); }

  /// What the next step depends on, with the particles at `now` and the bodies where the environment has them. Throws
  /// std::runtime_error where this scene cannot have it.
  template <class Archive>
  void exchange(Archive& archive, const environment::Environment& environment, const integrator::State& now);

  int proximities() const { return engine_.proximities(); }
  double min_distance() const { return engine_.min_distance(); }

 private:
  std::string describe(const collision::CornerPair& pair) const;
  std::string describe(const collision::Pinch& pinch) const;
  void note_pinches();
  void copy_obstacles(const environment::Environment& environment, std::vector<Vec3>& all) const;

  std::vector<std::string> names_;   // per body
  std::vector<std::size_t> bodies_;  // of the environment, those that collide
  std::size_t particles_;
  std::vector<Vec3> all_t0_, all_t1_;  // particles, then vertices of the obstacles
  std::vector<std::uint8_t> movable_;
  collision::Engine engine_;

  using PinchingObjects = std::pair<std::size_t, std::size_t>;  // cloth and obstacle
  std::set<PinchingObjects> pinching_, pinching_before_;        // in this frame and in the one before
  Pinches pinches_;
};

}  // namespace weft::simulation
