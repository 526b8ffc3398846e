// From candidate triangle pairs to the vertex-face and edge-edge pairs that are close now.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/lanes.hpp"
#include "collision/hierarchy/surface.hpp"
#include "collision/proximity/feature_pair.hpp"
#include "collision/proximity/features.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Two features closer than the reach, with their closest points: Σ w x = distance · normal.
struct Proximity : FeaturePair {
  /// Edge-edge: sine of the angle by which the normal leaves the wedge of edge a and b, the directions in which no face
  /// at the edge comes closer than the edge itself; ≤ 0 inside, 0 for vertex-face. Above 0 a neighbouring pair
  /// is closer, and the response may leave this one out.
  std::array<double, 2> outside_wedge{};
};

/// Finds proximities among candidates. Listed are, of all vertex-face and edge-edge pairs without a common vertex whose
/// distance is below the reach, those whose closest points are
///   - inside the face: always;
///   - inside both edges: always;
///   - on an edge or at a vertex of the face: only if no other face around that edge or vertex is closer, and then
///   once.
/// What is left out is a duplicate or a poorer neighbour: a face around the edge or vertex S where the closest point
/// lies contains that point, so its distance is no larger, and going from face to face like this, or from an edge pair
/// with its closest point at an end to the faces around the other edge, distances never grow; ties go to the lower
/// number, so the walk ends, at a listed pair. So for each feature pair within reach of two triangles without a
/// common vertex a listed pair is at least as close, and the least distance of all is always listed.
class ProximityFinder {
 public:
  ProximityFinder() = default;

  /// Triangles of all surfaces in their global numbering; they must outlive this.
  ProximityFinder(std::span<const Triangle> triangles, Index vertex_count) : features_(triangles, vertex_count) {}

  /// Keeps the pairs of features that are closer than `radius` [m] at x [m]. The candidates must hold every pair of
  /// triangles closer than that (up to those with a common edge, which are looked up for each surface of `deformable`).
  /// Edge pairs are left out where the sines of half the angles by which the surface is folded along either edge add up
  /// to less than `flattest`: between two smooth layers vertices and faces tell all, and four of five pairs are edges.
  void gather(const CandidatePairs& candidates, std::span<const Surface> deformable, std::span<const Vec3> x,
              double radius, double flattest = 0);
  /// The same with candidates without a common vertex alone: those with one or two are looked up for each surface of
  /// `deformable`. `open`: per triangle, not 0 where what shares a vertex with it is known to be no closer.
  void gather(const PairList& apart, std::span<const Surface> deformable, std::span<const Vec3> x, double radius,
              double flattest, std::span<const std::uint8_t> open);

  /// Replaces `out` by the proximities below `reach` [m] among the pairs gathered, in their order. Complete as long as
  /// no vertex is farther than (radius − reach) / 2 from where it was gathered.
  void find(std::span<const Vec3> x, double reach, std::vector<Proximity>& out) const;

  /// Both at once.
  void find(const CandidatePairs& candidates, std::span<const Surface> deformable, std::span<const Vec3> x,
            double reach, std::vector<Proximity>& out) {
    gather(candidates, deformable, x, reach);
    find(x, reach, out);
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
  /// Edge i of a triangle goes from its corner i to corner i + 1.
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

  struct First;
  First begin_gathering(std::span<const Vec3> x, double radius, double flattest);
  void look_at(std::span<const TrianglePair> pairs, const First& first);
  void append_connected(std::size_t begin, std::size_t end, const Surface& surface, std::span<const std::uint8_t> open,
                        std::vector<TrianglePair>& pairs) const;
  void measure_folds(std::span<const Vec3> x);

  Features features_;
  std::vector<std::array<float, 3>> folds_;  ///< per triangle and edge it owns: sine of half the fold; 1 at borders
  std::vector<Rounded> rounded_;             ///< positions in float, for the first look
  FeaturePairs pairs_;
};

}  // namespace weft::collision
