// The guarantee: no two triangles meet during a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/surface.hpp"
#include "collision/response/carried_starts.hpp"
#include "collision/response/certificate.hpp"
#include "collision/response/fans.hpp"
#include "collision/response/pinch.hpp"
#include "collision/response/planes.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// What `movable` says of a vertex: obstacles never move, particles do, and those that pins hold give way only where
/// nothing else can.
enum Movable : std::uint8_t { kFixed = 0, kFree = 1, kPinned = 2 };

/// A pinned particle that gave way, and what it would have met.
struct GivenWay {
  Index particle;
  CornerPair pair;
};

struct SeparationReport {
  bool separated = false;          ///< every pair has a certificate
  int corrected_pairs = 0;         ///< pairs that needed a correction
  double largest_push = 0;         ///< [m]
  std::vector<GivenWay> gave_way;  ///< pinned particles that could not be kept where they are held
  CornerPair stuck{};              ///< a pair that could not be separated, where not `separated`
};

/// Vertices that move together only: those of a rigid body, and of its frame.
struct RigidGroup {
  Index first, count;        ///< of its vertices
  Index frame, frame_count;  ///< of the particles that carry them
  double mass;               ///< [kg]
};

/// Keeps triangles apart over the linear motion from x_t0 to x_t1 by moving separating planes (see `separates`): those
/// without a common vertex pair by pair, those of a surface that share one by the fans around their vertices. Triangles
/// that share an edge meet only where they are folded onto each other exactly; the triangles around keep them from
/// that.
///
/// A pair without certificate has its end positions pushed apart along n, the closest direction at the start, until a
/// gap remains: by half each, obstacles and held particles not at all. What was moved is checked again, until nothing
/// fails. Particles that keep failing are backtracked, at last all the way: to where they started, or, once they fail
/// with an obstacle that moves as a rigid body, to where that would have carried them. Nothing met at the start, so
/// what stays together or rides together is as far apart as it was, and growing clusters of particles that do end the
/// rounds. What is left over is driven into each other: by obstacles that move differently, or held particles. Of that,
/// cloth can be given up to obstacles.
///
/// Cloth gives way to rigid bodies as to obstacles. These give way to obstacles and to each other, by translation, the
/// lighter one more.
class Separation {
 public:
  Separation() = default;
  /// `triangles`: of all surfaces, by global number; `deformable`: those that can meet themselves.
  /// `masses`: of the particles [kg], all the same if empty; must outlive it.
  Separation(std::span<const Triangle> triangles, std::span<const Surface> deformable,
             std::span<const double> masses = {});

  /// Of vertices that can move. Before the first watch().
  void set_rigid(std::vector<RigidGroup> groups, Index vertices);

  /// From now on looks after these pairs without a common vertex, and after all fans, with x [m] as the positions that
  /// motion is measured from. The pairs must hold all that can meet; where motion or a correction carries a vertex out
  /// of the bounds they were collected with, collect and watch again.
  void watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x);
  /// The same with those that exchange() has brought.
  void watch(std::span<const Vec3> x);
  /// As Planes::exchange().
  void exchange(PairList& pairs) { planes_.exchange(pairs); }

  /// Appends the watched pairs that may be closer than `radius` at x [m].
  void append_closer(double radius, std::span<const Vec3> x, PairList& out) const;

  /// Per triangle, 1 where all triangles of its surface that share a vertex with it were farther from it than
  /// `distance` at x [m], but for where they share that.
  std::vector<std::uint8_t> open_triangles(double distance, std::span<const Vec3> x) const;

  /// Pairs without a certificate for the way from x_t0 to x_t1; changes nothing. x_t0 must be free of intersections but
  /// those of `pinched`, which are not looked at.
  /// Pairs with an obstacle that turns are seen from there. `which` counts where ends are others than in the last call.
  std::span<const CornerPair> find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                                           const PinchedPairs* pinched = nullptr,
                                           const CarriedStarts* carried = nullptr,
                                           Certificates which = Certificates::all);

  /// Changes x_t1 of what is movable until every pair has a certificate. Where that fails,
  /// pairs of cloth and obstacle are added to `pinched`, if given. `goes_on`: with what the last call found to be
  /// carried, over other pairs.
  SeparationReport enforce(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable,
                           PinchedPairs* pinched = nullptr, const CarriedStarts* carried = nullptr,
                           bool goes_on = false);

  /// What has been found since watch(), for an object that watches the same pairs from the same positions.
  template <class Archive>
  void serialize(Archive& archive) {
    planes_.serialize(archive, reference_);
  }

 private:
  /// What enforce() works on.
  struct Step {
    std::span<const Vec3> x_t0;
    std::span<Vec3> x_t1;
    std::vector<std::uint8_t> movable;
    PinchedPairs* pinched;
    const CarriedStarts* carried;
    SeparationReport report = {};
    std::span<const Vec3> start_of(const CornerPair& pair) const { return carried ? carried->of(pair, x_t0) : x_t0; }
  };
  double balanced_plane(const CornerPair& pair, const Vec3& n, double target, const Step& step) const;
  bool push_apart(const CornerPair& pair, Step& step) const;
  bool translate_groups(const CornerPair& pair, const Vec3& n, double target, Step& step) const;
  const RigidGroup* group_of(Index v) const {
    return group_of_.empty() || group_of_[v] < 0 ? nullptr : &groups_[group_of_[v]];
  }
  template <class Visit>
  static void for_each_member(const RigidGroup& group, const Visit& visit);
  bool give_way(const CornerPair& pair, Step& step);
  bool choose_homes(const CornerPair& pair, const Step& step);
  const Vec3& home(Index v, const Step& step) const;
  bool rides(const CornerPair& pair) const;
  bool backtrack(const CornerPair& pair, bool all_the_way, Step& step);
  bool backtrack_all(Step& step) const;
  bool stays(const CornerPair& pair, const Step& step) const;
  void look_again(const Step& step);

  std::span<const Triangle> triangles_;
  std::span<const double> masses_;  // of the particles
  std::vector<Vec3> reference_;
  Planes planes_;
  Fans fans_;
  std::vector<float> moved_;                 // per vertex: bound of its distance from the reference at both ends [m]
  std::vector<Vec3> looked_t0_, looked_t1_;  // per vertex: where it was when last looked at [m]
  std::vector<std::uint8_t> changed_;        // per vertex: whether it is somewhere else now
  std::vector<int> backtracked_in_;          // per vertex: round in which it was last backtracked, 0 never
  std::vector<RigidGroup> groups_;
  std::vector<int> group_of_;  // per vertex, −1 of none; empty where there are no groups
  std::vector<int> rides_;     // per vertex: the obstacle that carries it when backtracked, or one of these
  static constexpr int kAtStart = -1, kAtStartForGood = -2;
  int round_ = 0;
  std::vector<CornerPair> failing_;
};

}  // namespace weft::collision
