// Compares GJK with the closed forms over all features, for triangles and quads of all shapes, crossing or not.
#include "physics/collision/proximity/gjk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/hierarchy/test_meshes.hpp"
#include "physics/collision/proximity/closest_points.hpp"

namespace weft::collision {
namespace {

using testing::random_vec;
using Polygon = std::vector<Vec3>;

/// Whether the segment from p to q pierces the triangle (a, b, c): signs of five volumes in long double.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  using Wide = Eigen::Matrix<long double, 3, 1>;
  const auto volume = [](const Vec3& o, const Vec3& u, const Vec3& v, const Vec3& w) {
    const Wide e = (u - o).cast<long double>(), f = (v - o).cast<long double>(), g = (w - o).cast<long double>();
    return e.dot(f.cross(g));
  };
  const long double side_p = volume(p, a, b, c), side_q = volume(q, a, b, c);
  if (!((side_p < 0 && side_q > 0) || (side_p > 0 && side_q < 0))) return false;
  const long double ab = volume(p, q, a, b), bc = volume(p, q, b, c), ca = volume(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

double triangle_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  double least_sq = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    least_sq = std::min(least_sq, closest_vertex_face(a[i], b[0], b[1], b[2]).distance_sq);
    least_sq = std::min(least_sq, closest_vertex_face(b[i], a[0], a[1], a[2]).distance_sq);
    for (std::size_t j = 0; j < 3; ++j)
      least_sq = std::min(least_sq, closest_edge_edge(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).distance_sq);
    if (pierces(a[i], a[(i + 1) % 3], b[0], b[1], b[2]) || pierces(b[i], b[(i + 1) % 3], a[0], a[1], a[2])) return 0;
  }
  return std::sqrt(least_sq);
}

/// Distance of two planar polygons: the minimum over all pairs of triangles of which they consist.
double distance_of_triangulations(const Polygon& a, const Polygon& b) {
  double minimum = 1e300;
  for (std::size_t i = 1; i + 1 < a.size(); ++i)
    for (std::size_t j = 1; j + 1 < b.size(); ++j)
      minimum = std::min(minimum, triangle_distance({a[0], a[i], a[i + 1]}, {b[0], b[j], b[j + 1]}));
  return minimum;
}

double size_of(const Polygon& a, const Polygon& b) {
  double size = 0;
  for (const Polygon* polygon : {&a, &b})
    for (const Vec3& p : *polygon) size = std::max(size, (p - b[0]).cwiseAbs().maxCoeff());
  return size;
}

/// A random planar convex polygon. `kind` 0 to 3: triangles with a height of about 1, 1e-4, 1e-9 and 0 times their
/// length; 4 to 6: quads with the first three of these heights; 7: a point.
Polygon random_polygon(std::mt19937& generator, int kind) {
  const Vec3 o = random_vec(generator), e = random_vec(generator);
  const double flatness[] = {1, 1e-4, 1e-9, 0};
  const Vec3 f = flatness[kind % 4] * random_vec(generator) + (kind % 4 == 0 ? Vec3(Vec3::Zero()) : Vec3(0.3 * e));
  if (kind == 7) return {o, o, o};
  if (kind < 4) return {o, o + e, o + f};
  return {o, o + e, o + e + 0.7 * f, o + f};
}

/// Compares the distance, and the gap along the difference of the closest points, with brute force. `tolerance`:
/// relative to the size of the polygons.
void expect_right(const Polygon& a, const Polygon& b, double tolerance) {
  const Vec3 difference = closest_convex(a, b);
  const double expected = distance_of_triangulations(a, b), size = size_of(a, b), found = difference.norm();
  EXPECT_NEAR(found, expected, tolerance * size);
  if (found <= tolerance * size) return;  // the direction consists of rounding errors
  double lowest_a = 1e300, highest_b = -1e300;
  for (const Vec3& p : a) lowest_a = std::min(lowest_a, (p - b[0]).dot(difference) / found);
  for (const Vec3& p : b) highest_b = std::max(highest_b, (p - b[0]).dot(difference) / found);
  // Rounding tilts the direction of a short difference by about 1e-16 size / distance [rad], which lowers the gap by up
  // to size times this angle.
  EXPECT_GE(lowest_a - highest_b, expected - tolerance * size - 1e-14 * size * size / std::max(expected, 1e-300));
}

/// Relative tolerances: 30 times the largest errors measured in 600,000 pairs of the first test, 7e-16 and 1.5e-15.
constexpr double kOrdinary = 2e-14, kNeedle = 5e-14;

TEST(Gjk, EqualsTheClosedFormsForTrianglesAndQuadsOfAllKindsAndScales) {
  std::mt19937 generator(21);
  for (int i = 0; i < 20000; ++i) {
    const int kind_a = i % 8, kind_b = (i / 8) % 8;
    const double scale = std::pow(10.0, i % 10 - 6), away = (i / 64) % 3;
    Polygon a = random_polygon(generator, kind_a), b = random_polygon(generator, kind_b);
    const Vec3 shift = away * random_vec(generator);
    for (Vec3& p : a) p = scale * p;
    for (Vec3& p : b) p = scale * (p + shift);
    SCOPED_TRACE(::testing::Message() << i << " kinds " << kind_a << " " << kind_b);
    expect_right(a, b, kind_a % 4 == 0 && kind_b % 4 == 0 ? kOrdinary : kNeedle);
    if (HasFailure()) break;
  }
}

TEST(Gjk, FindsParallelPolygonsTheirDistanceApart) {
  std::mt19937 generator(22);
  for (int i = 0; i < 2000; ++i) {
    Polygon a = random_polygon(generator, i % 2 == 0 ? 0 : 4), b = a;
    const Vec3 normal = (a[1] - a[0]).cross(a[2] - a[0]).normalized();
    const double gap = std::pow(10.0, i % 7 - 6);
    const Vec3 slide = 0.2 * (i % 5) * (a[1] - a[0]);
    for (Vec3& p : b) p += gap * normal + slide;
    expect_right(a, b, kOrdinary);
    if (i % 5 == 0) {
      EXPECT_NEAR(closest_convex(a, b).norm(), gap, 1e-13 * (1 + size_of(a, b)));
    }
  }
}

TEST(Gjk, OfTouchingPolygonsIsZero) {
  std::mt19937 generator(23);
  for (int i = 0; i < 2000; ++i) {
    Polygon a = random_polygon(generator, i % 2 == 0 ? 0 : 4), b = random_polygon(generator, 0);
    // A corner of b touches a corner, an edge or the inside of a. The other corners of b are on one side of the plane
    // of a.
    const Vec3 n = (a[1] - a[0]).cross(a[2] - a[0]);
    const Vec3 place = i % 3 == 0 ? a[1] : i % 3 == 1 ? Vec3(0.5 * (a[0] + a[1])) : Vec3((a[0] + a[1] + a[2]) / 3);
    const Vec3 shift = place - b[0];
    for (Vec3& p : b) p += shift;
    for (std::size_t c = 1; c < 3; ++c)
      if (n.dot(b[c] - place) < 0) b[c] = place - (b[c] - place);
    EXPECT_LE(closest_convex(a, b).norm(), kOrdinary * size_of(a, b)) << i;
  }
}

TEST(Gjk, FarFromTheOriginLosesOnlyTheDigitsOfTheCoordinates) {
  std::mt19937 generator(24);
  for (int i = 0; i < 2000; ++i) {
    Polygon a = random_polygon(generator, 0), b = random_polygon(generator, 4);
    const Vec3 away = 1e3 * random_vec(generator);
    for (Vec3& p : a) p = 1e-3 * p + away;
    for (Vec3& p : b) p = 1e-3 * p + away;
    // Tolerance: rounding of coordinates up to 1 km makes the quad non-planar by 1e-13 m, so that the distance by GJK
    // differs from that by brute force.
    EXPECT_NEAR(closest_convex(a, b).norm(), distance_of_triangulations(a, b), 3e-13) << i;
  }
}

TEST(Gjk, OfAPointAndAWarpedQuadIsThatToTheTetrahedronOfItsCorners) {
  const Polygon quad{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}};
  EXPECT_EQ(closest_convex(Polygon{{0.5, 0.5, 0.5}}, quad).norm(), 0);
  EXPECT_NEAR(closest_convex(Polygon{{2, 0, 1}}, quad).norm(), 1, 1e-14);
  EXPECT_NEAR(closest_convex(Polygon{{0.5, 0.5, 3}}, quad).norm(), 2, 1e-14);
}

}  // namespace
}  // namespace weft::collision
