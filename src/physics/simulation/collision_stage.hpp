// Connects the cloths and bodies of a model to the collision engine, step by step.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "physics/collision/engine.hpp"
#include "physics/integrator/system.hpp"
#include "physics/model/model.hpp"
#include "physics/simulation/cloth_system.hpp"
#include "physics/simulation/rigid_vertices.hpp"
#include "physics/simulation/simulation.hpp"

namespace weft::simulation {

/// State of all particles and bodies at one time. `x`: positions of the particles, then of the vertices of dynamic
/// bodies (moved by forces), then of those of key-framed bodies; only of bodies that collide. `v`: velocities of the
/// particles alone.
struct SystemState : integrator::State {
  double bodies_time = 0;  ///< time at which the key-framed bodies in x are placed [s]

  std::span<const Vec3> particles() const { return {x.data(), v.size()}; }
};

/// Contact detection and separation for one model.
class CollisionStage {
 public:
  /// Whether anything in the model can collide. Otherwise, the caller makes no stage.
  static bool is_needed(const model::Model& model);

  /// Appends the vertices of the bodies at start.bodies_time to start.x. The model must outlive the stage.
  CollisionStage(const model::Model& model, const ClothSystem& cloth, SystemState& start);

  /// Finds all places where surfaces touch or cross at the start, or are closer than
  /// Numerics::Separation::least_gap. A run may begin only if there is none, because the guarantee
  /// against penetration holds only for surfaces that start apart.
  std::vector<IntersectionPlace> find_intersections(const SystemState& start);

  /// Lifts dynamic bodies that touch something at the start, because scenes place a box exactly on its support. A body
  /// that touches an obstacle or cloth rises by 0.2 mm along the unit vector `up`; of two dynamic
  /// bodies that touch, the one with the higher centre rises. This is repeated until nothing
  /// touches, at most 33 times. Bodies that are not yet released at t [s] stay. Returns the largest
  /// lift [m]. If surfaces that untangle() does not move still touch, changes nothing and returns
  /// 0.
  double lift_bodies(const Vec3& up, double t, SystemState& start);

  /// Moves cloth that touches or crosses something at the start, if Cloth::may_be_untangled(). Particles in `held`
  /// stay, and so do the cloths whose numbers are in `put_on`. If a new cloth is worn over a put-on one, all new
  /// cloths end up outside of that one. If an obstacle goes through cloth that has no way out, throws
  /// Error(scene_invalid) with objects and places. Other intersections may remain: see find_intersections().
  void untangle(std::span<const integrator::HeldParticle> held, std::span<const std::size_t> put_on,
                SystemState& start);

  /// Copies which cloth is pinched from a stage that this one replaces. Cloth k of `before` has the
  /// number `cloths[k]` in this stage.
  void copy_state_from(const CollisionStage& before, std::span<const std::size_t> cloths);

  /// Begins a step, before its solve. Places bodies at t in `now` and at t + h in `next`. Predicts the particles of
  /// `next`: held ones at their targets, others with unchanged velocity. Finds contacts for `now` and this prediction.
  /// With springs, if surfaces would touch on the predicted trajectories, moves particles of `next` apart. Returns
  /// whether any was moved. `is_repeated`: whether a longer step that contains this one was rejected.
  bool begin_step(double t, double h, std::span<const integrator::HeldParticle> held, SystemState& now,
                  SystemState& next, bool is_repeated = false);

  /// The search for contacts assumes that vertices move on straight lines. Returns whether an obstacle near cloth, or
  /// near a body that forces move, turns so far between t and t + h [s], about its origin or with an object that it
  /// follows, that its vertices may deviate from such lines by more than `numerics.contact.verlet_margin` detection
  /// distances.
  bool obstacle_turns_too_far(double t, double h, const SystemState& now) const;

  /// Whether all key-framed bodies have the same positions at t0 and t1 [s], the times of `now` and `next`. Bodies that
  /// come near neither cloth nor dynamic bodies do not count. Places bodies in both states.
  bool bodies_are_constant(double t0, double t1, SystemState& now, SystemState& next) const;

  /// Whether all vertices of obstacles near cloth move by at most `numerics.contact.verlet_margin`
  /// detection distances from `now` to `next`. If so, a shorter step would not find more space for
  /// cloth.
  bool obstacles_move_little(const SystemState& now, const SystemState& next) const;

  /// The vertices of dynamic bodies; nullptr if there are none.
  const RigidVertices* rigid_vertices() const { return rigid_.empty() ? nullptr : &rigid_; }
  /// After a solve that ends at `next`: computes the vertices of dynamic bodies from their frames.
  void place_rigid_vertices(SystemState& next) const { rigid_.place(next.x); }

  collision::ContactResponse& response() { return engine_.response(); }
  const collision::ContactResponse& response() const { return engine_.response(); }

  /// Appends the particles whose motion velocity constraints prescribe, without those that pins hold.
  void append_prescribed_particles(std::vector<integrator::HeldParticle>& held) const;

  /// After the solve: whether each pair that is not pinched has a separating plane on the trajectory to `next`.
  bool is_separated(const SystemState& now, const SystemState& next) {
    return engine_.is_separated(trajectory_start(now), next.x);
  }
  /// After is_separated() has returned false: whether a pair without a plane was not pushed apart before in this step.
  bool fails_anew() const { return engine_.fails_anew(); }

  /// After is_separated() has returned false: adds contacts for the pairs without a plane, and returns how many
  /// contacts are new. The forces of these contacts keep the pairs apart in the next solve; push_apart() would move
  /// particles instead.
  int add_failing_contacts(const SystemState& now, const SystemState& next) {
    return engine_.add_failing_contacts(now.x, next.x);
  }

  /// Corrects positions and velocities of `next` until each pair has a separating plane. Cloth that has no space
  /// between obstacles becomes pinched: the obstacles may intersect it. If `may_pinch` is false, only an obstacle that
  /// pinches the cloth already may intersect it. Moves pinned particles only if nothing else separates a pair and
  /// `may_move_pins` is true. If a pinned particle would have to move but `may_move_pins` is false,
  /// fails, and obstructed_pins() lists the particle. Returns nothing on success, else a text that
  /// says which objects cannot be separated, and where.
  std::optional<std::string> push_apart(double h, bool may_pinch, bool may_move_pins, const SystemState& now,
                                        SystemState& next);
  /// After push_apart(): makes the corrected `next` the new start of the step's trajectory, and finds contacts there.
  void continue_from(const SystemState& next);
  /// Whether each particle of `next` is where it was in the last call of continue_from() in this step; false without
  /// such a call. The tolerance is the gap that push_apart() restores or, if smaller, the Verlet margin
  /// (Numerics::Contact::verlet_margin).
  bool restarts_at(const SystemState& next) const;
  /// Adds to obstructed_pins() the pinned particles of cloth triangles between which is_separated() found no plane.
  /// Returns whether obstructed_pins() has any.
  bool find_pins_between_cloths();
  /// The pinned particles that the last push_apart() or find_pins_between_cloths() has listed.
  std::span<const collision::ObstructedPin> obstructed_pins() const { return obstructed_pins_; }
  /// Empties this list. Call before another solve: if that solve fails, the solver is the reason, not these pins.
  void forget_obstructed_pins() { obstructed_pins_.clear(); }
  /// Text that says which object obstructs this pinned particle, and where: "'a' near (0, 0, 0) m".
  std::string describe(const collision::ObstructedPin& pin, const SystemState& now) const;

  /// Cloth that obstacles pinched in the steps of a frame. take_pinches() also begins the next frame.
  struct Pinches {
    int pairs = 0;  ///< as FrameReport::pinched_pairs
    /// One text per pair of objects that is new in this frame: "'a' has no room between ..."
    std::vector<std::string> begun;
  };
  Pinches take_pinches(const SystemState& last_start);  ///< `last_start`: start of the last step

  void accept() { engine_.accept(); }

  /// Before a frame: drops search state that does not follow from positions, see Engine::forget().
  void forget() { engine_.forget(); }

  /// Saves or restores all that the next step from `now`, at t [s], depends on. Throws std::runtime_error if the
  /// archive does not fit.
  template <class Archive>
  void serialize(Archive& archive, double t, SystemState& now);
  /// Saves or restores only what accepted steps have changed (Engine::serialize_events()) and which pinches were
  /// reported. Restoring discards the pinches of a frame that has not ended.
  template <class Archive>
  void serialize_events(Archive& archive);

  int proximities() const { return engine_.proximities(); }
  double min_distance() const { return engine_.min_distance(); }

 private:
  // Where the trajectory of the step starts: at the start of the step, or where continue_from() was last called.
  const std::vector<Vec3>& trajectory_start(const SystemState& now) const {
    return x_restart_.empty() ? now.x : x_restart_;
  }
  RigidVertices make_rigid_vertices(const ClothSystem& cloth) const;
  std::vector<double> masses_of_all(const ClothSystem& cloth) const;
  const std::vector<Vec3>& append_bodies(SystemState& start) const;
  bool is_dynamic(std::size_t body) const { return model_.bodies[bodies_[body]].dynamics != nullptr; }
  bool is_moved_by_forces(std::size_t body, double t_end) const;
  void place_bodies(double t, SystemState& state) const;
  double origin_sagitta(std::size_t body, double t, double h) const;
  bool solved_surface_comes_near(std::size_t body, double t, double h, double angle, double of_origin,
                                 const SystemState& now) const;
  collision::RigidMotion motion_of(std::size_t body, double t, double h) const;
  std::string describe(const collision::CornerPair& pair, const SystemState& state) const;
  std::string describe(const collision::Pinch& pinch) const;
  void note_pinches(const SystemState& start);
  template <class Archive>
  void serialize_reported_pinches(Archive& archive);

  const model::Model& model_;
  std::vector<std::string> names_;   // of all cloths, then of all bodies_
  std::vector<std::size_t> bodies_;  // numbers in the model; dynamic bodies come first, see colliding_bodies()
  std::vector<double> radii_;  // per body: largest distance of a vertex from the origin [m]; 0: still or deforming
  std::vector<Box3> boxes_;    // bounding box of each body in its own coordinates
  std::size_t particles_;
  RigidVertices rigid_;
  std::vector<double> masses_;                   // of particles, then of the vertices of dynamic bodies [kg]
  std::vector<std::uint8_t> movable_;            // per vertex: collision::kFree, kPinned or kFixed
  std::vector<collision::RigidMotion> motions_;  // of the current step, per cloth and body
  std::vector<collision::ObstructedPin> obstructed_pins_;
  std::vector<Vec3> x_restart_;  // positions of the last continue_from(); empty: not called in this step
  std::vector<Vec3> solved_;     // scratch: solved particles, before push_apart() moves them
  collision::Engine engine_;

  using PinchingObjects = std::pair<std::size_t, std::size_t>;  // numbers of cloth and obstacle
  std::set<PinchingObjects> pinching_, pinching_before_;        // in this frame and in the previous one
  Pinches pinches_;
};

}  // namespace weft::simulation
