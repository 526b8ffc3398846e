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
#include "simulation/rigid_vertices.hpp"
#include "simulation/simulation.hpp"

namespace weft::simulation {

/// Where everything is at one time: particles, and behind them in x the vertices of the bodies that collide, of those
/// first that forces move.
struct Moment : integrator::State {
  double placed_for = 0;  ///< time that the bodies are placed for [s]

  std::span<const Vec3> particles() const { return {x.data(), v.size()}; }
};

/// Whether a cloth may be moved at the start for what it touches or crosses.
bool untangles(const scene::Cloth& cloth);
/// Whether one of the scene may.
bool untangles(const scene::Scene& scene);

class CollisionStage {
 public:
  /// Whether anything in the scene can collide; else no stage is made.
  static bool needed(const scene::Scene& scene);

  /// Appends the bodies to the moment `start`, for its time. The environment must outlive it.
  CollisionStage(const scene::Scene& scene, const environment::Environment& environment, const ClothSystem& cloth,
                 Moment& start);

  /// Where surfaces touch or cross at the start. A run begins only where none do: what begins apart is kept apart, and
  /// nothing else can be promised.
  std::vector<MeetingPlace> find_meetings(const Moment& start);

  /// Lifts bodies that forces move off what they touch at the start of a scene, since a block is written to stand where
  /// it touches: the upper one of two by fifths of a millimetre, until nothing touches; a body that keys hold is
  /// not moved. Returns the largest lift [m]. Changes nothing where that does not help.
  double lift_bodies(const Vec3& up, double t, Moment& start);

  /// Takes apart what touches or crosses at the start, as far as the scene has cloth that may be moved for it; `held`
  /// is not, nor is cloth that was `dressed` before (by number), outside of which others get if one of them is worn
  /// over it. Throws Error(scene_invalid) where there is no way, with what is where.
  void untangle(const scene::Scene& scene, std::span<const integrator::HeldParticle> held,
                std::span<const std::size_t> dressed, Moment& start);

  /// Goes on with what another has pinched, whose cloths are these here, by number.
  void take_over(const CollisionStage& before, std::span<const std::size_t> cloths);

  /// Before the solve: bodies go from where they are at t in `now` to where they are at t + h in `next`; contacts are
  /// found for the particles as they are now and would be with unchanged velocity. `next` has the latter then, moved
  /// apart where something would meet on the way there. Returns whether anything was moved.
  bool begin_step(double t, double h, std::span<const integrator::HeldParticle> held, Moment& now, Moment& next);

  /// Whether an obstacle with cloth near it turns so far between t and t + h that its way is no longer the straight one
  /// that the search takes it for.
  bool turns_too_far(double t, double h, const Moment& now) const;

  /// Whether all bodies that come near the cloth are at t1 where they are at t0 [s], the time of `now`.
  bool bodies_stay(double t0, double t1, Moment& now, Moment& next) const;

  /// Whether no obstacle moves so far between these that a shorter step could find room for cloth.
  bool obstacles_creep(const Moment& now, const Moment& next) const;

  /// Of the bodies that forces move; nullptr if there are none.
  const RigidVertices* rigid_vertices() const { return rigid_.empty() ? nullptr : &rigid_; }
  /// After a solve, whose end `next` is: their vertices follow their frames.
  void follow_frames(Moment& next) const { rigid_.place(next.x); }

  collision::ContactResponse& response() { return engine_.response(); }
  const collision::ContactResponse& response() const { return engine_.response(); }

  /// Appends what the response prescribes to the particles that no pin holds.
  void append_prescribed(std::vector<integrator::HeldParticle>& held) const;

  /// After the solve: whether nothing meets anything on the way to `next`.
  bool apart(const Moment& now, const Moment& next) { return engine_.apart(from(now), next.x); }

  /// Where apart() said no: makes contacts of the pairs that would meet, and says how many were new. If there are some,
  /// solving again lets the forces do what push_apart would do by moving particles.
  int adopt_failing(const Moment& now, const Moment& next) { return engine_.adopt_failing(now.x, next.x); }

  /// Corrects positions and velocities of `next` so that nothing meets anything, except cloth and the obstacles that
  /// leave it no room; these are then pinched. Without `may_pinch` no cloth becomes pinched by an obstacle that did not
  /// pinch it before. Empty if that worked, else which objects are stuck and where.
  /// `may_give_way`: pinned particles may be moved too, where nothing else can be; without, they are only told of.
  std::optional<std::string> push_apart(double h, bool may_pinch, bool may_give_way, const Moment& now, Moment& next);
  /// From `next`, where push_apart() has led to, the way of the step goes on, in another direction: contacts are found
  /// there.
  void go_on_from(const Moment& next);
  /// Whether pins hold particles of what apart() found to meet, cloth with cloth; these are in gave_way() then.
  bool find_pressing_pins();
  /// Whether the way may do so: with springs.
  bool may_bend() const { return response().form() == collision::ResponseForm::springs; }
  /// The pinned particles that the last push_apart() told of.
  std::span<const collision::GivenWay> gave_way() const { return gave_way_; }
  /// What such a particle would have met, and where: "'a' near (0, 0, 0) m".
  std::string describe(const collision::GivenWay& given, const Moment& now) const;

  /// What a frame has pinched, from its steps so far; the next call tells of the next frame.
  struct Pinches {
    int pairs = 0;                   ///< most triangles at once that are exempted from non-penetration
    std::vector<std::string> begun;  ///< those not in the frame before, by object: "'a' has no room between ..."
  };
  Pinches take_pinches(const Moment& last_start);  ///< where the last step began

  /// The step is done.
  void accept() { engine_.accept(); }

  /// Before a frame, of what the scene switches on: see Engine::forget.
  void forget() { engine_.forget(); }

  /// What the next step from `now`, at time t [s], depends on. Throws std::runtime_error where this scene cannot have
  /// it.
  template <class Archive>
  void serialize(Archive& archive, double t, Moment& now);

  int proximities() const { return engine_.proximities(); }
  double min_distance() const { return engine_.min_distance(); }

 private:
  // Where the piece of the way of this step begins that ends at its end.
  const std::vector<Vec3>& from(const Moment& now) const { return bend_.empty() ? now.x : bend_; }
  RigidVertices make_rigid_vertices(const ClothSystem& cloth) const;
  std::vector<double> masses_of_all(const ClothSystem& cloth) const;
  const std::vector<Vec3>& append_bodies(Moment& start) const;
  bool is_dynamic(std::size_t body) const { return environment_.bodies[bodies_[body]].dynamics != nullptr; }
  void place_bodies(double t, Moment& moment) const;
  bool cloth_comes_near(std::size_t body, double t, double h, double angle, const Moment& now) const;
  collision::RigidMotion motion_of(std::size_t body, double t, double h) const;
  std::string describe(const collision::CornerPair& pair, const Moment& moment) const;
  std::string describe(const collision::Pinch& pinch) const;
  void note_pinches(const Moment& start);

  const environment::Environment& environment_;
  std::vector<std::string> names_;   // per body
  std::vector<std::size_t> bodies_;  // of the environment, those that collide; first those that forces move
  std::vector<double> radii_;        // of these about their origins, where they are obstacles that move; else 0 [m]
  std::vector<Box3> boxes_;          // around these in their own coordinates
  std::size_t particles_;
  RigidVertices rigid_;
  std::vector<double> masses_;  // of particles, and of the vertices of bodies that forces move
  std::vector<std::uint8_t> movable_;
  std::vector<collision::RigidMotion> motions_;  // of the step at hand, per body
  std::vector<collision::GivenWay> gave_way_;
  std::vector<Vec3> bend_;    // where the way of the step last bent; empty: nowhere
  std::vector<Vec3> solved_;  // scratch: particles before they are pushed apart
  collision::Engine engine_;

  using PinchingObjects = std::pair<std::size_t, std::size_t>;  // cloth and obstacle
  std::set<PinchingObjects> pinching_, pinching_before_;        // in this frame and in the one before
  Pinches pinches_;
};

}  // namespace weft::simulation
