// Finds the intersecting triangles of a scene by exact predicates. Shares no code with the collision
// modules.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "film/frame/frame_snapshot.hpp"

namespace weft::support {

/// One object at its position in space. The spans must outlive the call of find_intersections().
struct TestedObject {
  std::string name;
  bool is_cloth = true;             ///< also for ropes; false: an obstacle, which may intersect other obstacles
  std::span<const Vec3> positions;  ///< one per vertex [m]
  std::span<const std::array<Index, 3>> triangles;
  std::span<const std::uint8_t> passed_through =
      {};  ///< per face: 1 if cloth may pass through it, so that it is not tested; empty: all are tested
};

/// A face, by the indices of its object in the list and of its triangle in the object.
struct TestedFace {
  std::size_t object = 0;
  Index face = 0;
  auto operator<=>(const TestedFace&) const = default;
};

/// Two faces that intersect or touch; a before b.
struct IntersectingPair {
  TestedFace a, b;
  auto operator<=>(const IntersectingPair&) const = default;
};

/// Result of find_intersections().
struct Intersections {
  std::vector<IntersectingPair> pairs;  ///< sorted, each pair once
  std::vector<TestedFace> degenerate;   ///< triangles without area and pieces of rope without length: not tested
};

/// Finds all intersecting pairs of cloth with the same cloth, another cloth or an obstacle. Exact for the given
/// doubles; touching counts. A face (a, b, b) is a piece of rope: the segment from a to b.
///
/// Skips faces of one object that share two or three vertices, since these always meet. If faces share one vertex,
/// tests the edge opposite to it in each against the other face. Throws std::invalid_argument for positions that are
/// not finite and for vertices that do not exist.
Intersections find_intersections(std::span<const TestedObject> objects);

/// The objects of a snapshot, which must outlive them. Characters are obstacles; invisible objects are tested too.
std::vector<TestedObject> objects_of(const frame::FrameSnapshot& snapshot);

/// Number of pairs between two objects, by name, such as {"ball", "sheet", 12}; sorted by name.
struct PairCount {
  std::string a, b;
  std::size_t count = 0;
  bool operator==(const PairCount&) const = default;
};
std::vector<PairCount> count_by_objects(const Intersections& intersections, std::span<const TestedObject> objects);

}  // namespace weft::support
