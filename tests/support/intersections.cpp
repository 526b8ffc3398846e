#include "support/intersections.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace weft::support {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;

/// A face with the data that intersection tests need.
struct Face {
  TestedFace id;
  std::array<Index, 3> vertices;
  std::array<Point, 3> corners;
  bool is_segment() const { return vertices[1] == vertices[2] && vertices[0] != vertices[1]; }
  std::size_t corner_count() const { return is_segment() ? 2 : 3; }
  Triangle triangle() const { return {corners[0], corners[1], corners[2]}; }
  Segment segment() const { return {corners[0], corners[1]}; }
  auto bbox() const { return is_segment() ? segment().bbox() : triangle().bbox(); }
  Segment edge_opposite(std::size_t corner) const { return {corners[(corner + 1) % 3], corners[(corner + 2) % 3]}; }
};

using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Face*>;

Point to_point(const TestedObject& object, Index vertex) {
  if (vertex < 0 || static_cast<std::size_t>(vertex) >= object.positions.size()) {
    throw std::invalid_argument(object.name + ": a face names vertex " + std::to_string(vertex) + " of " +
                                std::to_string(object.positions.size()));
  }
  const Vec3& p = object.positions[vertex];
  if (!p.allFinite()) {
    throw std::invalid_argument(object.name + ": the position of vertex " + std::to_string(vertex) + " is not finite");
  }
  return {p.x(), p.y(), p.z()};
}

// Faces of the scene: those of cloths, of obstacles, and those without area.
struct Faces {
  std::vector<Face> cloth, obstacles;
  std::vector<TestedFace> degenerate;

  explicit Faces(std::span<const TestedObject> objects) {
    for (std::size_t o = 0; o < objects.size(); ++o) {
      const TestedObject& object = objects[o];
      for (std::size_t f = 0; f < object.triangles.size(); ++f) {
        if (!object.passed_through.empty() && object.passed_through[f] != 0) continue;
        Face face{{o, static_cast<Index>(f)}, object.triangles[f], {}};
        for (std::size_t c = 0; c < 3; ++c) face.corners[c] = to_point(object, face.vertices[c]);
        if (face.is_segment() ? face.corners[0] == face.corners[1]
                              : CGAL::collinear(face.corners[0], face.corners[1], face.corners[2])) {
          degenerate.push_back(face.id);
        } else {
          (object.is_cloth ? cloth : obstacles).push_back(face);
        }
      }
    }
  }
};

std::vector<Box> boxes_of(const std::vector<Face>& faces) {
  std::vector<Box> boxes;
  boxes.reserve(faces.size());
  for (const Face& face : faces) boxes.emplace_back(face.bbox(), &face);
  return boxes;
}

// The number of vertices that two faces a and b share. The last shared vertex is corner of_a of a and corner of_b of b.
struct Shared {
  int count = 0;
  std::size_t of_a = 0, of_b = 0;
};

Shared shared_corners(const Face& a, const Face& b) {
  Shared shared;
  if (a.id.object != b.id.object) return shared;
  for (std::size_t i = 0; i < a.corner_count(); ++i) {
    for (std::size_t j = 0; j < b.corner_count(); ++j) {
      if (a.vertices[i] == b.vertices[j]) shared = {shared.count + 1, i, j};
    }
  }
  return shared;
}

// Whether the edge meets the face. Compares closed bounding boxes first: this is exact, and separates most neighbours
// in a sheet.
bool reaches(const Segment& edge, const Face& face) {
  const Triangle triangle = face.triangle();
  return CGAL::do_overlap(edge.bbox(), triangle.bbox()) && CGAL::do_intersect(edge, triangle);
}

// `segment` is a piece of rope; `other` is a triangle or a piece of rope. Two pieces with a common end meet elsewhere
// if the other end of one lies on the other, that is, if one is folded onto the other.
bool intersect_with_segment(const Face& segment, const Face& other) {
  const Segment own = segment.segment();
  if (!other.is_segment()) return CGAL::do_intersect(own, other.triangle());
  const Shared shared = shared_corners(segment, other);
  const Segment others = other.segment();
  if (shared.count == 0) return CGAL::do_intersect(own, others);
  return shared.count == 1 &&
         (own.has_on(other.corners[1 - shared.of_b]) || others.has_on(segment.corners[1 - shared.of_a]));
}

bool intersect(const Face& a, const Face& b) {
  if (a.is_segment()) return intersect_with_segment(a, b);
  if (b.is_segment()) return intersect_with_segment(b, a);
  const Shared shared = shared_corners(a, b);
  if (shared.count == 0) return CGAL::do_intersect(a.triangle(), b.triangle());
  if (shared.count > 1) return false;
  // Two faces that share one vertex meet elsewhere if and only if the edge opposite to this vertex in one face meets
  // the other face: their line of intersection begins at the shared vertex and ends on one of these edges.
  return reaches(a.edge_opposite(shared.of_a), b) || reaches(b.edge_opposite(shared.of_b), a);
}

}  // namespace

Intersections find_intersections(std::span<const TestedObject> objects) {
  Faces faces(objects);
  std::vector<Box> cloth = boxes_of(faces.cloth);
  std::vector<Box> obstacles = boxes_of(faces.obstacles);

  Intersections intersections;
  const auto test = [&](const Box& box_a, const Box& box_b) {
    const Face &a = *box_a.handle(), &b = *box_b.handle();
    if (intersect(a, b)) intersections.pairs.push_back({std::min(a.id, b.id), std::max(a.id, b.id)});
  };
  // Both calls reorder the boxes and report each pair of overlapping closed boxes once.
  CGAL::box_intersection_d(cloth.begin(), cloth.end(), obstacles.begin(), obstacles.end(), test);
  CGAL::box_self_intersection_d(cloth.begin(), cloth.end(), test);
  std::sort(intersections.pairs.begin(), intersections.pairs.end());
  intersections.degenerate = std::move(faces.degenerate);
  return intersections;
}

std::vector<TestedObject> objects_of(const frame::FrameSnapshot& snapshot) {
  std::vector<TestedObject> objects;
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    const frame::Surface& surface = *snapshot.surfaces[i];
    objects.push_back({surface.name,
                       surface.kind == frame::ObjectKind::cloth || surface.kind == frame::ObjectKind::rope,
                       snapshot.states[i].positions, surface.triangles, surface.passed_through});
  }
  return objects;
}

std::vector<PairCount> count_by_objects(const Intersections& intersections, std::span<const TestedObject> objects) {
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const IntersectingPair& pair : intersections.pairs) {
    const auto names = std::minmax(objects[pair.a.object].name, objects[pair.b.object].name);
    ++counts[{names.first, names.second}];
  }
  std::vector<PairCount> list;
  for (const auto& [names, count] : counts) list.push_back({names.first, names.second, count});
  return list;
}

}  // namespace weft::support
