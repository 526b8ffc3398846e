// Narrow phase: finds near vertex-face and edge-edge pairs among candidate pairs of triangles.
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

/// Two features closer than the detection distance, with their closest points: Σ weights x = distance · normal.
struct Proximity : FeaturePair {
  /// For an edge pair, one value for edge a and one for edge b: sine of the angle from the wedge of that edge to the
  /// direction towards the other edge; negative inside the wedge. The wedge of an edge is the set of directions,
  /// perpendicular to the edge, in which no face at the edge is closer than the edge. If a value is above 0, a
  /// neighbouring pair is closer, and the response may skip this one. For vertex-face pairs whose closest point is on
  /// an edge or at a vertex of the face, the first value is that of the wedge of the vertex, but 0 inside; else both
  /// are 0.
  std::array<double, 2> outside_wedge{};
};

/// Finds near pairs among candidate pairs. Of all vertex-face and edge-edge pairs without a common vertex and with a
/// distance below the detection distance, those are listed whose closest points are
///   - inside the face;
///   - inside both edges;
///   - on an edge or at a vertex of the face, if no other face around that edge or vertex is closer. If several faces
///   there are equally close, only one is listed. Every skipped pair is represented by a listed pair that is at least
/// as close. Proof: let S be the edge or vertex of the face where the closest point lies. Every face around S contains
/// that point, so the vertex is no farther from each of them. Likewise, if the closest point of an edge pair is at an
/// end, the faces around the other edge are no farther. From face to face, distances never grow, and ties go to the
/// lower number, so the chain ends at a listed pair. The smallest distance of all is therefore always listed.
class ProximityFinder {
 public:
  ProximityFinder() = default;

  /// `triangles`: of all surfaces in their global numbering; must outlive this object.
  ProximityFinder(std::span<const Triangle> triangles, Index vertex_count) : features_(triangles, vertex_count) {}

  /// Gathers all pairs of features closer than `radius` [m] at x [m], and some others. The candidates must include
  /// every pair of triangles closer than `radius`; pairs with a common edge are added here, for each surface of
  /// `deformable`. An edge pair is skipped if the sines of half the fold angles along both edges add up to less than
  /// `min_fold`. Between two smooth layers, four of five pairs are edge pairs, but vertices and faces suffice there.
  void gather(const CandidatePairs& candidates, std::span<const Surface> deformable, std::span<const Vec3> x,
              double radius, double min_fold = 0);
  /// Appends the candidates among the pairs [begin, end) of a list; called from several threads.
  using AppendPairs = std::function<void(std::size_t begin, std::size_t end, PairList& pairs)>;
  /// As above, with candidates without a common vertex only, from a list of `count` pairs. Pairs that share one or two
  /// vertices are added here, for each surface of `deformable`. `clear`: result of Separation::find_clear_triangles for
  /// `radius`.
  void gather(std::size_t count, const AppendPairs& append_apart, std::span<const Surface> deformable,
              std::span<const Vec3> x, double radius, double min_fold, std::span<const std::uint8_t> clear);

  /// Replaces `out` by the gathered pairs that are closer than `detection_distance` [m], ordered by kind and by
  /// the numbers of their vertices, whatever the order of the candidates. The list is complete as long as no vertex is
  /// farther than (radius − detection_distance) / 2 from its position in gather().
  void find(std::span<const Vec3> x, double detection_distance, std::vector<Proximity>& out) const;

  /// Gathers and finds.
  void find(const CandidatePairs& candidates, std::span<const Surface> deformable, std::span<const Vec3> x,
            double detection_distance, std::vector<Proximity>& out) {
    gather(candidates, deformable, x, detection_distance);
    find(x, detection_distance, out);
  }

 private:
  class Gathering;
  class Search;

  struct Rounded {
    Lanes4 xyz;
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
  std::vector<std::array<float, 3>> folds_;  ///< per triangle and owned edge: sine of half the fold angle; 1 at borders
  std::vector<Rounded> rounded_;             ///< positions in float, for the box tests
  FeaturePairs pairs_;
};

}  // namespace weft::collision
