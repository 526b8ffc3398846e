#include "support/exact_motion.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "support/exact_motion_queries.hpp"

namespace weft::support {
namespace {

using Corners = std::array<Vec3, 3>;

MovingSimplex still(const Corners& x) {
  return {3, x, x};
}
MovingSimplex moved(const Corners& x, const Vec3& by) {
  return {3, x, {x[0] + by, x[1] + by, x[2] + by}};
}
MovingSimplex edge(const Vec3& p0, const Vec3& q0, const Vec3& p1, const Vec3& q1) {
  return {2, {p0, q0, Vec3::Zero()}, {p1, q1, Vec3::Zero()}};
}
MovingSimplex reversed(MovingSimplex s) {
  std::swap(s.t0, s.t1);
  return s;
}
MovingSimplex turned(const MovingSimplex& s) {
  return {s.count, {s.t0[2], s.t0[0], s.t0[1]}, {s.t1[2], s.t1[0], s.t1[1]}};
}
// Scales and shifts by powers of two; exact for the coordinates of these tests.
MovingSimplex placed(MovingSimplex s, double scale, double shift) {
  for (int k = 0; k < 3; ++k) {
    s.t0[k] = scale * s.t0[k] + Vec3(shift, -shift, shift);
    s.t1[k] = scale * s.t1[k] + Vec3(shift, -shift, shift);
  }
  return s;
}

// Whether find_contact(a, b) finds a contact. Expects the same answer for swapped arguments, reversed time, scaled and
// shifted coordinates, and another first corner of a.
bool meet(const MovingSimplex& a, const MovingSimplex& b) {
  const bool found = find_contact(a, b).found;
  EXPECT_EQ(find_contact(b, a).found, found);
  EXPECT_EQ(find_contact(reversed(a), reversed(b)).found, found);
  EXPECT_EQ(find_contact(placed(a, 0x1p-2, 8), placed(b, 0x1p-2, 8)).found, found);
  if (a.count == 3) {
    EXPECT_EQ(find_contact(turned(a), b).found, found);
  }
  return found;
}

// A right triangle in the plane z = 0, and a triangle above it whose lowest corner is at height z.
const Corners kGround = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
Corners hanging_corners(double z) {
  return {Vec3(1, 1, z), Vec3(1, 1, z + 1), Vec3(2, 1, z + 1)};
}

// Expects that b meets a if b moves by `reach` along `direction`, and that it does not if the motion is shorter by
// 2⁻⁴⁰. `direction` is a unit vector along an axis, so that all products are exact.
void expect_first_contact(const Corners& a, const Corners& b, const Vec3& direction, double reach) {
  EXPECT_TRUE(meet(still(a), moved(b, reach * direction)));
  EXPECT_FALSE(meet(still(a), moved(b, (reach - 0x1p-40) * direction)));
  EXPECT_TRUE(meet(still(a), moved(b, 16 * reach * direction)));
  EXPECT_NEAR(find_contact(still(a), moved(b, reach * direction)).time, 1, 1e-15);
}

TEST(ExactMotion, FindsTheFirstContactOfVertexAndFace) {
  expect_first_contact(kGround, hanging_corners(2), {0, 0, -1}, 2);
  // The corner (1, 0, 1) meets the edge y = 0 of the ground.
  expect_first_contact(kGround, {Vec3(1, 0, 1), Vec3(1, 0, 2), Vec3(2, 0, 2)}, {0, 0, -1}, 1);
  // The corner (0, 4, 1) meets the corner (0, 4, 0) of the ground.
  expect_first_contact(kGround, {Vec3(0, 4, 1), Vec3(1, 4, 2), Vec3(1, 4, 3)}, {0, 0, -1}, 1);
}

TEST(ExactMotion, FindsTheFirstContactOfTwoEdges) {
  const Corners across{Vec3(1, -1, 2), Vec3(1, 1, 2), Vec3(1, 0, 3)};
  const Corners roof{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(2, 0, -3)};
  expect_first_contact(roof, across, {0, 0, -1}, 2);
}

TEST(ExactMotion, FindsContactInOnePlaneAndInOneLine) {
  const Corners beside{Vec3(-1, 1, 0), Vec3(-2, 1, 0), Vec3(-2, 2, 0)};  // its corner (-1, 1, 0) meets the edge x = 0
  expect_first_contact(kGround, beside, {1, 0, 0}, 1);
  const Corners facing{Vec3(-1, 1, 0), Vec3(-1, 2, 0), Vec3(-2, 2, 0)};  // its edge x = -1 meets the edge x = 0
  expect_first_contact(kGround, facing, {1, 0, 0}, 1);
  // Two triangles without area on one line.
  const Corners needle_a{Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2)};
  const Corners needle_b{Vec3(3, 3, 3), Vec3(5, 5, 5), Vec3(4, 4, 4)};
  EXPECT_TRUE(meet(still(needle_a), moved(needle_b, {-1, -1, -1})));
  EXPECT_FALSE(meet(still(needle_a), moved(needle_b, {-0.5, -0.5, -0.5})));
  const Corners point{Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)};
  expect_first_contact(kGround, point, {0, 0, -1}, 1);
  // A triangle without area: a segment from x = 0 to x = 2. A point meets it at x = 1.5, away from its three corners.
  const Corners bar{Vec3(0, 1, 0), Vec3(2, 1, 0), Vec3(1, 1, 0)};
  expect_first_contact(bar, {Vec3(1.5, 1, 1), Vec3(1.5, 1, 1), Vec3(1.5, 1, 1)}, {0, 0, -1}, 1);
  EXPECT_TRUE(meet(moved(point, {2, 0, 0}), moved({Vec3(3, 1, 1), Vec3(3, 1, 1), Vec3(3, 1, 1)}, {-2, 0, 0})));
  EXPECT_FALSE(meet(moved(point, {2, 0, 0}), moved({Vec3(3, 1, 2), Vec3(3, 1, 2), Vec3(3, 1, 2)}, {-2, 0, 0})));
}

TEST(ExactMotion, SlidingAlongInOnePlaneIsContactOnlyWhereTheyOverlap) {
  const Corners above{Vec3(8, 1, 0), Vec3(9, 1, 0), Vec3(9, 2, 0)};
  EXPECT_FALSE(meet(still(kGround), moved(above, {-4, 0, 0})));
  EXPECT_TRUE(meet(still(kGround), moved(above, {-5, 0, 0})));
  EXPECT_FALSE(meet(still(kGround), moved(above, {0, 8, 0})));
}

TEST(ExactMotion, TheWholeWayThroughCounts) {
  // From above the ground to below it: in contact neither at the start nor at the end.
  EXPECT_TRUE(meet(still(kGround), moved(hanging_corners(2), {0, 0, -7})));
  // Touches the ground from above at the start, and moves up.
  EXPECT_TRUE(meet(still(kGround), moved(hanging_corners(0), {0, 0, 5})));
  // Touches the ground from below with its upper edge at the start, and moves down.
  EXPECT_TRUE(meet(still(kGround), moved(hanging_corners(-1), {0, 0, -5})));
  // Crosses the ground all the time.
  EXPECT_TRUE(meet(still(kGround), still(hanging_corners(-0.5))));
  // Starts 2⁻⁴⁰ above the ground, and moves up.
  EXPECT_FALSE(meet(still(kGround), moved(hanging_corners(0x1p-40), {0, 0, 5})));
}

TEST(ExactMotion, GrazingIsContactAndPassingByIsNot) {
  // With s = t − 1/2, the face has the height z = s x. The first corner of the other triangle is at x = 1 + s and z = s
  // − depth: below the face by depth + s².
  const auto corner_at = [](double s, double depth) -> Corners {
    return {Vec3(1 + s, 1, s - depth), Vec3(1 + s, 1, s + 2), Vec3(2 + s, 1, s + 3)};
  };
  const auto face_at = [](double s) -> Corners { return {Vec3(0, 0, 0), Vec3(4, 0, 4 * s), Vec3(0, 4, 0)}; };
  const MovingSimplex face{3, face_at(-0.5), face_at(0.5)};
  const auto touches_from_below = [&](double depth) {
    // Moves the other two corners down by 6, so that the triangle is below the face, with its first corner on top.
    MovingSimplex low{3, corner_at(-0.5, depth), corner_at(0.5, depth)};
    for (auto* x : {&low.t0, &low.t1}) {
      (*x)[1].z() -= 6;
      (*x)[2].z() -= 6;
    }
    return meet(face, low);
  };
  EXPECT_TRUE(touches_from_below(0));
  EXPECT_FALSE(touches_from_below(0x1p-40));
  EXPECT_TRUE(touches_from_below(-0x1p-40));
}

TEST(ExactMotion, AnEdgeIsHeldAgainstATriangle) {
  const MovingSimplex face = still(kGround);
  EXPECT_TRUE(meet(edge({1, 1, 1}, {1, 2, 3}, {1, 1, 0}, {1, 2, 3}), face));
  EXPECT_FALSE(meet(edge({1, 1, 1}, {1, 2, 3}, {1, 1, 0x1p-40}, {1, 2, 3}), face));
  EXPECT_TRUE(meet(edge({1, 1, 1}, {1, 1, -1}, {1, 1, 1}, {1, 1, -1}), face));   // crosses from the start
  EXPECT_TRUE(meet(edge({5, 1, 1}, {5, 1, -1}, {1, 1, 1}, {1, 1, -1}), face));   // enters from the side
  EXPECT_FALSE(meet(edge({5, 1, 1}, {5, 1, -1}, {4, 1, 1}, {4, 1, -1}), face));  // stops outside
}

TEST(ExactMotion, FacesAboutOneVertexMeetBesideIt) {
  // Two faces share the origin. The second one is above the first and moves down until its other corners are at height
  // z: it crosses the first face, ends in its plane, or stops 2⁻⁴⁰ above it.
  const Corners flap{Vec3(0, 0, 0), Vec3(1, 2, 1), Vec3(2, 1, 1)};
  const auto fold = [&](double z) {
    const MovingSimplex b{3, flap, {flap[0], Vec3(1, 2, z), Vec3(2, 1, z)}};
    EXPECT_EQ(find_contact_beside_shared(b, 0, still(kGround), 0).found,
              find_contact_beside_shared(still(kGround), 0, b, 0).found);
    return find_contact_beside_shared(still(kGround), 0, b, 0).found;
  };
  EXPECT_TRUE(fold(-1));
  EXPECT_TRUE(fold(0));
  EXPECT_FALSE(fold(0x1p-40));
}

// --- Random queries on a coarse grid, where contact is common ------------------------------------

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

MovingSimplex on_grid(std::mt19937& engine, int count) {
  std::uniform_int_distribution<int> number(-3, 3);
  const auto point = [&] {
    const int x = number(engine), y = number(engine), z = number(engine);
    return Vec3(x, y, z);
  };
  MovingSimplex s{count, {}, {}};
  for (Corners* corners : {&s.t0, &s.t1})
    for (Vec3& x : *corners) x = point();
  return s;
}

Corners at(const MovingSimplex& s, double t) {
  Corners x;
  for (int k = 0; k < 3; ++k) x[k] = (1 - t) * s.t0[k] + t * s.t1[k];
  return x;
}

Kernel::Point_3 point(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

bool segments_intersect(const Corners& x, int count, const Kernel::Triangle_3& face) {
  for (std::size_t k = 0; k < (count == 2 ? 1u : 3u); ++k) {
    const Kernel::Segment_3 segment(point(x[k]), point(x[(k + 1) % 3]));
    if (!segment.is_degenerate() && CGAL::do_intersect(segment, face)) return true;
  }
  return false;
}

// Whether a and b intersect at time t; exact if the positions at t are. CGAL does not accept two degenerate triangles;
// the function regards these, and points, as separated.
bool intersect_at(const MovingSimplex& a, const MovingSimplex& b, double t) {
  const Corners x = at(a, t), y = at(b, t);
  const Kernel::Triangle_3 face_a(point(x[0]), point(x[1]), point(x[2])), face_b(point(y[0]), point(y[1]), point(y[2]));
  const bool proper_a = a.count == 3 && !face_a.is_degenerate(), proper_b = !face_b.is_degenerate();
  if (proper_a && proper_b) return CGAL::do_intersect(face_a, face_b);
  if (proper_b) return segments_intersect(x, a.count, face_b);
  return proper_a && segments_intersect(y, 3, face_a);
}

TEST(ExactMotion, AgreesWithStandingTrianglesAtSampledTimes) {
  std::mt19937 engine(1);
  int met = 0, apart = 0, in_integers = 0;
  for (int count : {3, 2}) {
    for (int query = 0; query < 4000; ++query) {
      const MovingSimplex a = on_grid(engine, count), b = on_grid(engine, 3);
      const Contact contact = find_contact(a, b);
      ++(contact.found ? met : apart);
      in_integers += contact.integers_used;
      // find_contact() must find each intersection at the sampled times k/32, at which coordinates are exact.
      for (int k = 0; k <= 32 && !contact.found; ++k)
        ASSERT_FALSE(intersect_at(a, b, k / 32.0)) << "query " << query << " at " << k / 32.0;
      // At the time of a contact that find_contact() finds, the triangles must intersect, or be separated only because
      // that time is rounded: by up to 1e-7 if it is a double root, by 1e-14 otherwise.
      if (contact.found && !intersect_at(a, b, contact.time)) {
        ASSERT_LE(distance_at(a, b, contact.time), 1e-7) << "query " << query;
      }
      if (query % 10 == 0) {
        EXPECT_EQ(meet(a, b), contact.found);
      }
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(apart, 1000);
  EXPECT_GT(in_integers, 100);
}

}  // namespace
}  // namespace weft::support
