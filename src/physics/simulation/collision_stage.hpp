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

/// State of all particles and bodies at one time. `x`: the particles, then the vertices of the bodies that collide;
/// bodies that forces move come first. `v`: the particles alone.
struct SystemState : integrator::State {
  double bodies_time = 0;  ///< time at which the key-framed bodies in x are placed [s]

  std::span<const Vec3> particles() const { return {x.data(), v.size()}; }
};

class CollisionStage {
 public:
  /// Whether anything in the model can collide. If not, no stage is made.
  static bool needed(const model::Model& model);

  /// Appends the vertices of the bodies at start.bodies_time to start.x. The model must outlive the stage.
  CollisionStage(const model::Model& model, const ClothSystem& cloth, SystemState& start);

  /// All places where surfaces touch or cross at the start. A run may begin only if there is none: the guarantee
  /// against penetration holds only for surfaces that start apart.
  std::vector<IntersectionPlace> find_intersections(const SystemState& start);

  /// Lifts dynamic bodies (moved by forces) that touch something at the start, because scenes place a box exactly on
  /// its support. Of two such bodies that touch, the upper one rises by 0.2 mm along the unit vector `up`, at most 33
  /// times; a body that touches anything else rises itself. Bodies that keys hold at t [s] stay. Returns the largest
  /// lift [m]. If surfaces still touch afterwards that untangle() does not move, changes nothing and returns 0.
  double lift_bodies(const Vec3& up, double t, SystemState& start);

  /// Moves cloth that touches or crosses something at the start, if Cloth::may_be_untangled(). Particles
  /// in `held` stay, and so do the cloths whose numbers are in `dressed`. If a new cloth is worn over a dressed one,
  /// all new cloths end up outside of the dressed one. Throws Error(scene_invalid) with objects and places if an
  /// obstacle goes through cloth that has no way out. Other intersections may remain: see find_intersections().
  void untangle(std::span<const integrator::HeldParticle> held, std::span<const std::size_t> dressed,
                SystemState& start);

  /// Copies the pinched pairs of another stage. `cloths[k]`: number in this stage of cloth k of `before`.
  void copy_state_from(const CollisionStage& before, std::span<const std::size_t> cloths);

  /// Begins a step, before its solve. Places bodies at t in `now` and at t + h in `next`. Predicts the particles of
  /// `next`: held ones at their targets, others with unchanged velocity. Finds contacts for `now` and this prediction.
  /// If the predicted trajectories would meet, moves their ends apart. Returns whether it moved any.
  bool begin_step(double t, double h, std::span<const integrator::HeldParticle> held, SystemState& now,
                  SystemState& next);

  /// The search assumes straight trajectories. Returns whether an obstacle near cloth turns so far between t and t + h
  /// [s] that its vertices deviate from them by more than `numerics.contact.margin` detection distances.
  bool obstacle_turns_too_far(double t, double h, const SystemState& now) const;

  /// Whether no key-framed body near cloth or bodies that forces move moves between t0 and t1 [s]; t0 is the time of
  /// `now`. Places bodies in both states.
  bool bodies_are_constant(double t0, double t1, SystemState& now, SystemState& next) const;

  /// Whether no obstacle near cloth moves by more than `numerics.contact.margin` detection distances from `now` to
  /// `next`. If so, a shorter step would not find more space for cloth.
  bool obstacles_move_little(const SystemState& now, const SystemState& next) const;

  /// The vertices of bodies that forces move; nullptr if there are none.
  const RigidVertices* rigid_vertices() const { return rigid_.empty() ? nullptr : &rigid_; }
  /// After a solve that ends at `next`: computes the vertices of these bodies from their frames.
  void place_rigid_vertices(SystemState& next) const { rigid_.place(next.x); }

  collision::ContactResponse& response() { return engine_.response(); }
  const collision::ContactResponse& response() const { return engine_.response(); }

  /// Appends the particles whose motion the contact response prescribes, without those that pins hold.
  void append_prescribed_particles(std::vector<integrator::HeldParticle>& held) const;

  /// After the solve: whether no pair meets on the trajectory to `next`.
  bool is_separated(const SystemState& now, const SystemState& next) {
    return engine_.is_separated(trajectory_start(now), next.x);
  }

  /// After is_separated() has failed: makes contacts of the pairs that would meet, and returns how many are new. In the
  /// next solve, the new contacts keep these pairs apart by forces, whereas push_apart() moves particles.
  int add_failing_contacts(const SystemState& now, const SystemState& next) {
    return engine_.add_failing_contacts(now.x, next.x);
  }

  /// Corrects positions and velocities of `next` so that no pair meets. Cloth that has no space between obstacles
  /// becomes pinched: the obstacles may intersect it. If `may_pinch` is false, only obstacles that already pinch a
  /// cloth may do so. If `may_move_pins` is true, pinned particles move, too, if nothing else helps; otherwise
  /// obstructed_pins() lists them. Returns nothing on success, else a text that says which objects are stuck, and
  /// where.
  std::optional<std::string> push_apart(double h, bool may_pinch, bool may_move_pins, const SystemState& now,
                                        SystemState& next);
  /// Restarts the trajectory of the step from `next`, as push_apart() has corrected it, and finds contacts there.
  void continue_from(const SystemState& next);
  /// Whether each particle is where the trajectory was last restarted, within the gap that push_apart() restores, and
  /// within the margin of the search for near features.
  bool restarts_at(const SystemState& next) const;
  /// Whether pins hold particles of cloth triangles between which is_separated() found no plane. obstructed_pins() then
  /// lists those particles.
  bool find_pins_between_cloths();
  /// The pinned particles that the last push_apart() or find_pins_between_cloths() found.
  std::span<const collision::ObstructedPin> obstructed_pins() const { return obstructed_pins_; }
  /// Text that says what this pinned particle would have met, and where: "'a' near (0, 0, 0) m".
  std::string describe(const collision::ObstructedPin& given, const SystemState& now) const;

  /// What obstacles pinched in the steps of a frame. take_pinches() also begins the next frame.
  struct Pinches {
    int pairs = 0;  ///< largest number of pinched cloth triangles at once, each counted once per obstacle limb
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

  int proximities() const { return engine_.proximities(); }
  double min_distance() const { return engine_.min_distance(); }

 private:
  // Where the trajectory of the step starts: at the start of the step, or where it was last restarted.
  const std::vector<Vec3>& trajectory_start(const SystemState& now) const {
    return x_restart_.empty() ? now.x : x_restart_;
  }
  RigidVertices make_rigid_vertices(const ClothSystem& cloth) const;
  std::vector<double> masses_of_all(const ClothSystem& cloth) const;
  const std::vector<Vec3>& append_bodies(SystemState& start) const;
  bool is_dynamic(std::size_t body) const { return model_.bodies[bodies_[body]].dynamics != nullptr; }
  void place_bodies(double t, SystemState& moment) const;
  bool cloth_comes_near(std::size_t body, double t, double h, double angle, const SystemState& now) const;
  collision::RigidMotion motion_of(std::size_t body, double t, double h) const;
  std::string describe(const collision::CornerPair& pair, const SystemState& moment) const;
  std::string describe(const collision::Pinch& pinch) const;
  void note_pinches(const SystemState& start);

  const model::Model& model_;
  std::vector<std::string> names_;   // of all cloths, then of all bodies_
  std::vector<std::size_t> bodies_;  // numbers in the model; those that forces move come first, see colliding_bodies()
  std::vector<double> radii_;  // per body: largest distance of a vertex from its origin [m]; 0: still or deforming
  std::vector<Box3> boxes_;    // bounding box of each body in its own coordinates
  std::size_t particles_;
  RigidVertices rigid_;
  std::vector<double> masses_;                   // of particles, then of the vertices of bodies that forces move [kg]
  std::vector<std::uint8_t> movable_;            // per vertex: collision::kFree, kPinned or kFixed
  std::vector<collision::RigidMotion> motions_;  // of the current step, per cloth and body
  std::vector<collision::ObstructedPin> obstructed_pins_;
  std::vector<Vec3> x_restart_;  // where the trajectory of the step was last restarted; empty: it was not
  std::vector<Vec3> solved_;     // scratch: solved particles, before push_apart() moves them
  collision::Engine engine_;

  using PinchingObjects = std::pair<std::size_t, std::size_t>;  // numbers of cloth and obstacle
  std::set<PinchingObjects> pinching_, pinching_before_;        // in this frame and in the previous one
  Pinches pinches_;
};

}  // namespace weft::simulation
