// The judge: which triangles of a scene intersect, decided by exact predicates that share no code with the collision
// modules.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::support {

/// One object as it lies in space. The spans must outlive the judging.
struct JudgedObject {
  std::string name;
  bool is_cloth = true;             ///< or rope; false: an obstacle, which may intersect other obstacles
  std::span<const Vec3> positions;  ///< one per vertex [m]
  std::span<const std::array<Index, 3>> triangles;
  std::span<const std::uint8_t> passed_through =
      {};  ///< of each 1 where cloth may be: it is not judged; empty: all are
};

/// A face of an object of the list.
struct JudgedFace {
  std::size_t object = 0;
  Index face = 0;
  auto operator<=>(const JudgedFace&) const = default;
};

/// Two faces that intersect or touch; a before b.
struct IntersectingPair {
  JudgedFace a, b;
  auto operator<=>(const IntersectingPair&) const = default;
};

struct Judgement {
  std::vector<IntersectingPair> pairs;  ///< sorted, each once
  std::vector<JudgedFace> degenerate;   ///< faces without area; they have no inside to intersect and are not judged
};

/// A face (a, b, b) is a piece of rope: the segment between its ends.
///
/// All intersecting pairs of cloth with the same cloth, another cloth or an obstacle. Exact for the given doubles;
/// touching counts. Faces of one object that share two or three vertices are skipped, since they meet anyway; of those
/// that share one vertex, the edge opposite to it in each is held against the other face. Throws
/// std::invalid_argument for positions that are not finite and for vertices that do not exist.
Judgement judge(std::span<const JudgedObject> objects);

/// The objects of a snapshot, which must live on; characters count as obstacles, invisible objects too are judged.
std::vector<JudgedObject> objects_of(const frame::FrameSnapshot& snapshot);

/// Number of pairs between two kinds of object, by name, such as {"ball", "sheet", 12}; sorted by name.
struct PairCount {
  std::string a, b;
  std::size_t count = 0;
  bool operator==(const PairCount&) const = default;
};
std::vector<PairCount> count_by_objects(const Judgement& judgement, std::span<const JudgedObject> objects);

}  // namespace weft::support
