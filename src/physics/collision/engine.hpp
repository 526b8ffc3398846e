// Collision of all cloths and obstacles over one time step.
//
//   CandidateCache     broad phase: candidate pairs of triangles, kept while valid
//   Separation         finds a separating plane for each pair; the gap along it is a lower bound of the distance
//   ProximityFinder    narrow phase: vertex-face and edge-edge pairs closer than the detection distance (near pairs)
//   ContactBuilder     near pairs -> contacts with stiffness, activation distance, friction
//   ContactResponse    contacts in the solve, as springs or as velocity constraints
//   Separation         checks the solved step; corrects pairs that would meet
//   PinchedPairs       cloth without space between obstacles, which Separation exempts
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/bodies.hpp"
#include "physics/collision/candidate_cache.hpp"
#include "physics/collision/contact_builder.hpp"
#include "physics/collision/proximity/proximities.hpp"
#include "physics/collision/response/carried_starts.hpp"
#include "physics/collision/response/contact_response.hpp"
#include "physics/collision/response/pinch_report.hpp"
#include "physics/collision/response/separation.hpp"
#include "physics/collision/variants/coherence.hpp"

namespace weft::collision {

struct EngineParameters {
  SearchParameters search;
  ContactParameters contact;
  ResponseForm response = ResponseForm::springs;
  double stick_speed = numerics.contact.stick_velocity;  ///< as in ContactSet::set_step() [m/s]
};

/// In each step, the caller first calls begin_step(). After each solve, it calls is_separated(). If pairs fail (have no
/// separating plane), it calls push_apart(), which corrects the positions, and either accepts the result or calls
/// continue_from() for another solve. With velocity constraints, it may call add_failing_contacts() for another solve
/// instead. It calls accept() when it accepts the step.
class Engine {
 public:
  /// `x`: all vertices at the start of the run [m]. `masses`: of the particles [kg]; must outlive the engine.
  Engine(Bodies bodies, const EngineParameters& parameters, std::span<const Vec3> x, std::span<const double> masses);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Finds the contacts of a step over h [s] from x_t0. x_t1: the expected end, exact for
  /// obstacles, an estimate for particles. Both must outlive the step. `motions`: one per body. For
  /// an obstacle that moves without deforming, this is its motion; for all other bodies, the
  /// identity. Empty: no obstacle moves in this way. With springs, if triangles would meet on the
  /// way to x_t1, corrects x_t1 by push_apart(), which may neither exempt cloth nor move pinned
  /// particles here. If this correction fails, x_t1 stays unchanged. `movable`: per vertex, a value
  /// of Movable; empty: no correction. `is_repeated`: see PinchedPairs::update_exempted(). Returns whether a
  /// correction succeeded.
  bool begin_step(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable, double h,
                  std::span<const RigidMotion> motions = {}, bool is_repeated = false);

  /// Continues the step from x [m], in which obstacles are at the end of the step. Surfaces must not intersect on the
  /// way from x_t0 to x. Finds new contacts at x. Also adds contacts for all pairs that were in failing() when
  /// push_apart() was called since begin_step(), and that it has not exempted. Friction still measures slip from the
  /// start of the step. In later calls in this step, pass x as x_t0. x must outlive the step.
  void continue_from(std::span<const Vec3> x);
  /// Pairs for which is_separated() found no separating plane. Valid until the next call of a function that tests
  /// pairs; empty after push_apart().
  std::span<const CornerPair> failing() const { return failing_; }
  /// Whether failing() has a pair that was in none of the calls of push_apart() since begin_step().
  bool fails_anew() const;

  /// Call between two steps. Deletes the state of separation lists, velocity cones and coherent detection, so that
  /// results do not depend on earlier steps.
  void forget();

  /// Saves or restores the state on which the next step depends, in addition to the positions x [m]. Throws
  /// std::runtime_error if restored data do not fit these bodies.
  template <class Archive>
  void serialize(Archive& archive, std::span<const Vec3> x);
  /// Saves or restores only pinched cloth and the state of walls. This is enough to return to an earlier step of the
  /// same run, because candidate pairs and planes are tested against the positions before each use.
  template <class Archive>
  void serialize_events(Archive& archive);

  ContactResponse& response() { return response_; }
  const ContactResponse& response() const { return response_; }

  /// Whether every pair of triangles that is not exempted has a separating plane on the trajectory from x_t0 to x_t1.
  bool is_separated(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Adds contacts for the pairs in failing(). Returns for how many of them the closest features
  /// had no contact of full stiffness before.
  int add_failing_contacts(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Call when the step is accepted; see ContactResponse::accept().
  void accept() { response_.accept(); }

  /// Corrects the ends x_t1 of movable particles until no triangles meet during the step. If a triangle of cloth and an
  /// obstacle cannot be separated, exempts this triangle from the limb of the obstacle. The correction fails in two
  /// cases: if `may_pinch` is false and it would exempt a cloth from an obstacle that does not pinch this cloth yet; or
  /// if `may_move_pins` is false and a pinned particle has to move. Then the result is not `separated`, nothing is
  /// exempted, and x_t1 may be changed in part. `which`: see Planes::kinds_of().
  SeparationReport push_apart(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable,
                              bool may_pinch = false, bool may_move_pins = true, PlaneKinds which = PlaneKinds::all);

  /// Number of exempted cloth triangles, each counted once per limb of an obstacle from which it is exempt.
  int pinched_pairs() const { return static_cast<int>(pinched_.size()); }
  /// The pinched cloths and the obstacles that they intersect. Pass the start x [m] of the last step.
  std::vector<Pinch> pinches(std::span<const Vec3> x) const {
    return list_pinches(pinched_, bodies_, candidates_.hierarchies(), x);
  }

  /// The exempted triangles. If this engine replaces another one, call exempt() between two steps
  /// for each triangle that the other engine has exempted.
  const PinchedPairs& exempted() const { return pinched_; }
  void exempt(const PinchedPairs::Key& key, const PinchedPairs::Origin& origin) { pinched_.add(key, origin); }

  /// Number of near pairs of features in the last step, without those of continued solves. With velocity constraints,
  /// these are the pairs near at the start of the step; with springs, those near at its expected end. Exception: if no
  /// plane of constant direction separates two triangles in the step, their features count if they are near at the
  /// start.
  int proximities() const { return static_cast<int>(proximities_.size()); }
  /// Smallest distance of the pairs that proximities() counts [m]; infinite if there are none.
  double min_distance() const;

  /// Pairs of triangles that touch, cross or are closer than Numerics::Separation::least_gap at x [m]. Valid as long as
  /// failing().
  std::span<const CornerPair> find_intersections(std::span<const Vec3> x);

  const Bodies& bodies() const { return bodies_; }
  /// Detection distance: features closer than this are near [m].
  double detection_distance() const { return candidates_.detection_distance(); }
  /// Whether this body is an obstacle that no particle can meet in the current step, so that its motion has no effect.
  bool is_clear(std::size_t body) const { return candidates_.is_clear(body); }

 private:
  void collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  void update_coherence(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  template <class Collect>
  void collect_by(std::span<const Vec3> x_t0, const Collect& list_pairs);
  void gather(std::span<const Vec3> x);
  bool separate_guess(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable);
  bool find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, PlaneKinds which);
  void find_near_at_expected_end(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  int add_failing(std::span<const CornerPair> pairs, const StepMotion& motion);
  void add_contacts(std::span<const Proximity> near, const StepMotion& motion);
  void begin_contacts(std::span<const Vec3> x_from, std::span<const Vec3> x_t1);
  void find_near(std::span<const Vec3> x, std::vector<Proximity>& near);
  template <class Archive>
  void serialize_candidates(Archive& archive);

  Bodies bodies_;
  CandidateCache candidates_;
  bool has_self_collision_;  // whether cloth collides with itself and with other cloth
  Separation separation_;
  ProximityFinder finder_;
  std::vector<Vec3> gathered_at_;               // positions for which finder_ gathered features [m]; empty: none
  std::optional<CoherentDetection> coherence_;  // if enabled, keeps pairs and closest points instead of candidates_
  ContactBuilder builder_;
  ContactResponse response_;
  std::vector<Vec3> predicted_walls_x_t1_;  // see ContactResponse::predict_wall_contacts() [m]
  PinchedPairs pinched_;
  CarriedStarts carried_;

  double step_ = 0;                                 // h [s]
  std::span<const Vec3> x_t0_;                      // start of the step
  std::vector<PinchedPairs::Push> pinched_pushes_;  // pushes of pinched cloth in this step
  std::vector<CornerPair> pushed_pairs_;  // failing() at each call of push_apart() in this step, if not exempt; a pair
                                          // that was pushed n times gets n contacts at each corner
  std::vector<Proximity> proximities_;    // near pairs at the expected end of the step, or at its start
  std::span<const CornerPair> failing_;   // of the last call of find_failing()
};

}  // namespace weft::collision
