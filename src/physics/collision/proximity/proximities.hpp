// Narrow phase: finds near vertex-face and edge-edge pairs among candidate pairs of triangles. Near: closer than the
// detection distance.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/lanes.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/proximity/feature_pair.hpp"
#include "physics/collision/proximity/features.hpp"

namespace weft::collision {

/// Two near features with their closest points: Σ weights x = distance · normal.
struct Proximity : FeaturePair {
  /// Sine of the angle by which the contact direction, between the closest points, leaves the wedge of a feature. The
  /// wedge of a vertex or edge consists of the directions (of an edge: perpendicular to it) in which no adjacent face
  /// is closer than the vertex or edge itself. For an edge pair, these are the values of edge a and edge b, negative
  /// inside the wedge. For a vertex-face pair, the first value is that of the vertex, and the second is 0. The first is
  /// also 0 if the direction is inside the wedge of the vertex, or if the closest point is inside the face. If a value
  /// is above 0, a neighbouring pair is closer, so the response may skip this pair.
  std::array<double, 2> outside_wedge{};
};

/// Finds near pairs among candidate pairs. Of all near vertex-face and edge-edge pairs without a common vertex, it
/// lists those whose closest points are
///   - inside the face;
///   - inside both edges;
///   - on an edge or at a vertex of the face, if no other face around that edge or vertex is closer. If several faces
///     are equally close, it lists only one pair.
///
/// Every near pair that is not listed is represented by a listed pair that is at least as close. Proof: let the point
/// of a face closest to a vertex lie on the edge or vertex S of the face. Every face around S contains that point, so
/// the vertex is no farther from each of them. Likewise, if a closest point of an edge pair is an end of its edge, this
/// end is no farther from the faces around the other edge. Repeat this step from the face found. Distances never grow,
/// and the step chooses the face with the lowest number among equally distant faces. So the repetition ends at a listed
/// pair.
class ProximityFinder {
 public:
  ProximityFinder() = default;

  /// `triangles`: of all surfaces in their global numbering; must outlive this object.
  ProximityFinder(std::span<const Triangle> triangles, Index vertex_count) : features_(triangles, vertex_count) {}

  /// Gathers all pairs of features closer than `radius` [m] at x [m], and some that are farther
  /// apart. The candidates must include every pair of triangles closer than `radius`, except pairs
  /// with a common edge, which gather() adds for each surface of `deformable`. Skips an edge pair
  /// if the sines of half the fold angles along both edges add up to less than `min_fold`: between
  /// two smooth layers, four of five pairs would be edge pairs, but vertex-face pairs suffice to
  /// keep the layers apart.
  void gather(const CandidatePairs& candidates, std::span<const Surface> deformable, std::span<const Vec3> x,
              double radius, double min_fold = 0);
  /// Appends those of the pairs [begin, end) of a list that are candidates. Several threads call
  /// this function at the same time.
  using AppendPairs = std::function<void(std::size_t begin, std::size_t end, PairList& pairs)>;
  /// As the first gather(), with candidates from a list of `count` pairs without a common vertex. Adds the pairs of
  /// `deformable` with one or two common vertices, except pairs with a `clear` triangle (found by
  /// Separation::find_clear_triangles for the distance `radius`).
  void gather(std::size_t count, const AppendPairs& append_apart, std::span<const Surface> deformable,
              std::span<const Vec3> x, double radius, double min_fold, std::span<const std::uint8_t> clear);

  /// Replaces `out` by the gathered pairs that are closer than `detection_distance` [m] and not
  /// represented by other pairs (see above), sorted by kind and by the numbers of their vertices.
  /// Let `radius` be that of the last gather(). The list is complete if no vertex is farther than
  /// (radius − detection_distance) / 2 from its position in that gather(). Edge pairs that gather()
  /// skipped because of `min_fold` are missing in any case.
  void find(std::span<const Vec3> x, double detection_distance, std::vector<Proximity>& out) const;

  void find(const CandidatePairs& candidates, std::span<const Surface> deformable, std::span<const Vec3> x,
            double detection_distance, std::vector<Proximity>& out) {
    gather(candidates, deformable, x, detection_distance);
    find(x, detection_distance, out);
  }

 private:
  class Gathering;
  class Search;

  struct Rounded {
    Lanes4 xyz;  // position in float
  };
  struct VertexFace {
    Index vertex, face;
  };
  /// Edge i of a triangle connects corners i and i + 1. face_a has the lower number.
  struct EdgeEdge {
    Index face_a, face_b;
    std::uint8_t edge_a, edge_b;
  };
  struct FeaturePairs {
    std::vector<VertexFace> vertex_faces;
    std::vector<EdgeEdge> edge_edges;

    friend void append(FeaturePairs& to, const FeaturePairs& more) {
      to.vertex_faces.insert(to.vertex_faces.end(), more.vertex_faces.begin(), more.vertex_faces.end());
      to.edge_edges.insert(to.edge_edges.end(), more.edge_edges.begin(), more.edge_edges.end());
    }
  };

  struct GatherParameters;
  GatherParameters begin_gathering(std::span<const Vec3> x, double radius, double min_fold);
  void test_pairs(std::span<const TrianglePair> pairs, const GatherParameters& parameters);
  void append_connected(std::size_t begin, std::size_t end, const Surface& surface, std::span<const std::uint8_t> clear,
                        std::vector<TrianglePair>& pairs) const;
  void measure_folds(std::span<const Vec3> x);

  Features features_;
  std::vector<std::array<float, 3>> folds_;  ///< per owned edge; see measure_folds() in the .cpp
  std::vector<Rounded> rounded_;             ///< all positions, for the box tests
  FeaturePairs pairs_;
};

}  // namespace weft::collision
