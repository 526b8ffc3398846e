// Collision of all cloths and obstacles over one time step: who is near, what pushes back, and that nothing passes.
//
//   CandidateCache     which pairs of triangles can meet, and for how long that holds
//   Separation         a separating plane for each of them, which bounds their distance from below
//   ProximityFinder    of those that the planes leave near: vertices and faces, edges and edges within the reach, where
//                      the step is expected to end
//   ContactBuilder     from these to contacts: stiffness, range, friction
//   ContactResponse    what the contacts do in the solve, as springs or as constraints of velocities
//   Separation         that no pair meets on the way to what was solved; what does is a contact more, or moved apart
//   PinchedPairs       cloth that obstacles leave no room, exempted from that
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/bodies.hpp"
#include "collision/candidate_cache.hpp"
#include "collision/contact_builder.hpp"
#include "collision/proximity/coherence.hpp"
#include "collision/proximity/proximities.hpp"
#include "collision/response/carried_starts.hpp"
#include "collision/response/contact_response.hpp"
#include "collision/response/pinch_report.hpp"
#include "collision/response/separation.hpp"
#include "core/types.hpp"

namespace weft::collision {

struct EngineParameters {
  SearchParameters search;
  ContactParameters contact;
  ResponseForm response = ResponseForm::springs;
  double stick_speed = numerics.contact.stick_velocity;  ///< of springs [m/s]
};

class Engine {
 public:
  /// `x`: all vertices at the start [m]; `masses`: of the particles [kg]; must outlive the engine.
  Engine(Bodies bodies, const EngineParameters& parameters, std::span<const Vec3> x, std::span<const double> masses);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Finds the contacts of a step over h [s] from x_t0, with x_t1 the expected end: obstacles exactly, particles by
  /// guess. `motions`: of each body, as far as it keeps its shape; of none where nothing moves so. Both positions must
  /// outlive the step. With springs, a guess at which surfaces have met is pushed apart in x_t1; `movable` says which
  /// vertices (see Separation; empty: none). Returns whether x_t1 has changed.
  bool begin_step(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable, double h,
                  std::span<const RigidMotion> motions = {});

  /// The way of the step bends: it has come to x [m] without meeting anything, with obstacles where they end, and goes
  /// on from there. Contacts are found anew around x, with those of all pairs that were pushed apart in this step; what
  /// slips in them still counts from where the step began. x takes the place of x_t0 in the calls that follow, and must
  /// outlive the step.
  void go_on_from(std::span<const Vec3> x);
  /// Pairs that the last call of apart() found to meet.
  std::span<const CornerPair> failing() const { return failing_; }

  /// Lets go, between two steps, of what only makes the search faster and does not follow from positions.
  void forget();

  /// What the next step from x [m] depends on, besides that. Throws std::runtime_error where these bodies cannot have
  /// it.
  template <class Archive>
  void serialize(Archive& archive, std::span<const Vec3> x);

  /// The contacts found, to act inside the solve.
  ContactResponse& response() { return response_; }
  const ContactResponse& response() const { return response_; }

  /// Whether every pair of triangles stays apart on the way to x_t1.
  bool apart(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Makes contacts of the pairs for which the last call of apart() said no; returns how many are new.
  int adopt_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// The step is done.
  void accept() { response_.accept(); }

  /// Corrects the ends x_t1 of movable particles so that no triangles meet during the step. Cloth that obstacles leave
  /// no room is exempted from that: `may_pinch` allows it; without, only where the obstacle pinches this cloth already.
  /// Without `may_give_way` the report of pinned particles that gave way is that of a failure, and nothing is exempted.
  SeparationReport push_apart(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable,
                              bool may_pinch = false, bool may_give_way = true);

  /// Triangles of cloth that are pinched by an obstacle, counted per obstacle.
  int pinched_pairs() const { return static_cast<int>(pinched_.size()); }
  /// Which cloths and obstacles that are, with places at x [m], where the last step began.
  std::vector<Pinch> pinches(std::span<const Vec3> x) const {
    return list_pinches(pinched_, bodies_, candidates_.hierarchies(), x);
  }

  /// What is exempted, and adding to it between two steps: for an engine that goes on where another has come to.
  const PinchedPairs& exempted() const { return pinched_; }
  void exempt(const PinchedPairs::Key& key, const PinchedPairs::Origin& origin) { pinched_.add(key, origin); }

  /// Pairs of features within the reach, 1.5 contact ranges, where the last step was expected to end; of pairs that
  /// would have met on the way there, where it began.
  int proximities() const { return static_cast<int>(proximities_.size()); }
  /// Their smallest distance [m]; infinite if there are none.
  double min_distance() const;

  /// All pairs that touch or cross at x [m]. Valid until the next call of this, apart() or begin_step().
  std::span<const CornerPair> find_meetings(std::span<const Vec3> x);

  const Bodies& bodies() const { return bodies_; }
  /// Distance below which features are near [m].
  double reach() const { return candidates_.reach(); }
  /// Whether cloth cannot meet a body in the step that was begun last: what that does then has no influence.
  bool is_clear(std::size_t body) const { return candidates_.is_clear(body); }

 private:
  void collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  void update_coherence(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  template <class Collect>
  void collect_by(std::span<const Vec3> x_t0, const Collect& list_pairs);
  void gather(std::span<const Vec3> x);
  void count_failures();
  bool separate_guess(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable);
  bool find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, Certificates which);
  void look_ahead(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  int add_failing(std::span<const CornerPair> pairs, const StepMotion& motion);
  void add_contacts(std::span<const Proximity> near, const StepMotion& motion);
  void begin_contacts(std::span<const Vec3> x_from, std::span<const Vec3> x_t1);
  void find_near(std::span<const Vec3> x, std::vector<Proximity>& near);
  template <class Archive>
  void serialize_candidates(Archive& archive);

  Bodies bodies_;
  CandidateCache candidates_;
  bool meets_itself_;  // cloth, and other cloth
  Separation separation_;
  ProximityFinder finder_;
  std::vector<Vec3> gathered_at_;  // where the finder gathered features of these candidates [m]; empty: nowhere
  PairList closer_;                // scratch: candidates that are near there
  std::optional<CoherentDetection> coherence_;  // keeps pairs and closest points in place of the cache, where wanted
  ContactBuilder builder_;
  ContactResponse response_;
  std::vector<Vec3> leaning_;
  std::vector<std::uint8_t> failures_;  // of each particle, in the step
  PinchedPairs pinched_;
  CarriedStarts carried_;

  double step_ = 0;                                 // h [s]
  std::span<const Vec3> x_t0_;                      // where the step began
  std::vector<PinchedPairs::Push> pinched_pushes_;  // back out of obstacles, of the step
  std::vector<CornerPair> pushed_;                  // pairs that were pushed apart in it
  std::vector<Proximity> proximities_;              // at the start of the step, or its expected end
  std::vector<Proximity> near_bend_;                // where its way last bent
  std::span<const CornerPair> failing_;             // of the last call of apart()
};

}  // namespace weft::collision
