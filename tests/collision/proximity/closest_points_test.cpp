// Compares the closed forms of closest points with a minimisation in quadruple precision that tries every support (set
// of vertices with a weight other than 0).
#include "physics/collision/proximity/closest_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace weft::collision {
namespace {

__extension__ typedef __float128 Quad;
using QuadVec = std::array<Quad, 3>;

QuadVec exact(const Vec3& v) {
  return {v[0], v[1], v[2]};
}
QuadVec minus(const QuadVec& a, const QuadVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Quad dot(const QuadVec& a, const QuadVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Foot of the perpendicular from a point w to a line or plane through the origin. `inside`: the foot is inside the
/// edge u, the triangle (0, u, v) or, for a pair of edges, the parallelogram of u and v.
struct Foot {
  bool inside;
  Quad distance_sq;
};

Foot foot_on_line(const QuadVec& w, const QuadVec& u) {
  const Quad uu = dot(u, u);
  if (uu == 0) return {false, 0};
  const Quad t = dot(w, u) / uu;
  const QuadVec rest{w[0] - t * u[0], w[1] - t * u[1], w[2] - t * u[2]};
  return {t > 0 && t < 1, dot(rest, rest)};
}

Foot foot_on_plane(const QuadVec& w, const QuadVec& u, const QuadVec& v, bool triangle) {
  const Quad uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
  if (det <= 0) return {false, 0};
  const Quad s = (vv * dot(w, u) - uv * dot(w, v)) / det, t = (uu * dot(w, v) - uv * dot(w, u)) / det;
  const QuadVec rest{w[0] - s * u[0] - t * v[0], w[1] - s * u[1] - t * v[1], w[2] - s * u[2] - t * v[2]};
  const bool inside = s > 0 && t > 0 && (triangle ? s + t < 1 : s < 1 && t < 1);
  return {inside, dot(rest, rest)};
}

void keep(Quad& best, const Foot& foot) {
  if (foot.inside && foot.distance_sq < best) best = foot.distance_sq;
}

double exact_vertex_face(const Vec3& p, const std::array<Vec3, 3>& t) {
  const QuadVec q = exact(p);
  std::array<QuadVec, 3> c{exact(t[0]), exact(t[1]), exact(t[2])};
  Quad best = dot(minus(q, c[0]), minus(q, c[0]));
  for (std::size_t i = 0; i < 3; ++i) {
    best = std::min(best, dot(minus(q, c[i]), minus(q, c[i])));
    keep(best, foot_on_line(minus(q, c[i]), minus(c[(i + 1) % 3], c[i])));
  }
  keep(best, foot_on_plane(minus(q, c[0]), minus(c[1], c[0]), minus(c[2], c[0]), true));
  return std::sqrt(static_cast<double>(best));
}

double exact_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const std::array<QuadVec, 2> p{exact(p0), exact(p1)}, q{exact(q0), exact(q1)};
  Quad best = dot(minus(p[0], q[0]), minus(p[0], q[0]));
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) best = std::min(best, dot(minus(p[i], q[j]), minus(p[i], q[j])));
    keep(best, foot_on_line(minus(p[i], q[0]), minus(q[1], q[0])));
    keep(best, foot_on_line(minus(q[i], p[0]), minus(p[1], p[0])));
  }
  keep(best, foot_on_plane(minus(q[0], p[0]), minus(p[1], p[0]), minus(q[0], q[1]), false));
  return std::sqrt(static_cast<double>(best));
}

/// Checks that the weights of the first `on_a` vertices are positive and sum to 1, that those of the others are
/// negative and sum to −1, and that all give `difference`. `size`: of the geometry [m].
void expect_consistent(const ClosestPoints& c, const std::array<Vec3, 4>& x, int on_a, double size) {
  const auto split = c.weights.begin() + on_a;
  EXPECT_NEAR(std::accumulate(c.weights.begin(), split, 0.0), 1, 1e-15);
  EXPECT_NEAR(std::accumulate(split, c.weights.end(), 0.0), -1, 4e-16);
  EXPECT_TRUE(std::all_of(c.weights.begin(), split, [](double w) { return w >= 0; }));
  EXPECT_TRUE(std::all_of(split, c.weights.end(), [](double w) { return w <= 0; }));
  Vec3 difference = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) difference += c.weights[i] * (x[i] - x[0]);
  EXPECT_LE((difference - c.difference).norm(), 1e-14 * size);
  EXPECT_DOUBLE_EQ(c.distance_sq, c.difference.squaredNorm());
}

/// Random numbers. In length(), each order of magnitude from 1 µm to 1 km is equally likely.
class Numbers {
 public:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }
  double length() { return std::pow(10.0, std::uniform_real_distribution<double>(-6, 3)(generator_)); }
  Vec3 vec() { return {unit(), unit(), unit()}; }

 private:
  std::mt19937 generator_{7};
};

TEST(ClosestVertexFace, IsThePerpendicularFootInsideAndTheEdgeOrCornerOutsideEachBoundary) {
  const std::array<Vec3, 3> t{Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 1, 0}};
  struct Case {
    double x, y;
    unsigned support;  // bit 0: the point; bits 1 to 3: the corners of the triangle
  };
  constexpr double s = 1e-12, h = 0.5;
  // Points 1e-12 or 1e-9 m on either side of the three edges, and of the lines through each corner that are
  // perpendicular to its edges.
  const Case cases[] = {
      {h, h / 2, 0b1111},    {h, s, 0b1111},         {h, -s, 0b0111},         {s, h, 0b1111},
      {-s, h, 0b1011},       {1 - s, h - s, 0b1111}, {1 + s, h + s, 0b1101},  {s, -s, 0b0111},
      {-s, -s, 0b0011},      {-s, s, 0b1011},        {2 - s, -1, 0b0111},     {2 + s, -1, 0b0101},
      {3, 2 - 1e-9, 0b0101}, {3, 2 + 1e-9, 0b1101},  {-1, 1 - s, 0b1011},     {-1, 1 + s, 0b1001},
      {1, 3 - 1e-9, 0b1101}, {1, 3 + 1e-9, 0b1001},  {0.5, 2 + 1e-9, 0b1001}, {0.5, 2 - 1e-9, 0b1101}};
  for (const double z : {0.0, 1e-9, -0.3, 40.0}) {
    for (const Case& c : cases) {
      const Vec3 p{c.x, c.y, z};
      const ClosestPoints found = closest_vertex_face(p, t[0], t[1], t[2]);
      EXPECT_EQ(found.support(), c.support) << p.transpose();
      expect_consistent(found, {p, t[0], t[1], t[2]}, 1, 3 + std::abs(z));
      EXPECT_NEAR(std::sqrt(found.distance_sq), exact_vertex_face(p, t), 4e-16 * (3 + std::abs(z))) << p.transpose();
    }
  }
}

TEST(ClosestVertexFace, AgreesWithTheExactDistanceForTrianglesOfEverySizeAndPlace) {
  Numbers random;
  for (int i = 0; i < 20000; ++i) {
    const double size = random.length();
    const Vec3 place = random.vec() * 1000;
    const std::array<Vec3, 3> t{place + random.vec() * size, place + random.vec() * size, place + random.vec() * size};
    const Vec3 p = place + random.vec() * size;
    const ClosestPoints found = closest_vertex_face(p, t[0], t[1], t[2]);
    // Tolerance: ten times the largest measured error of the distance, 2e-15 of `size`.
    EXPECT_NEAR(std::sqrt(found.distance_sq), exact_vertex_face(p, t), 2e-14 * size);
    expect_consistent(found, {p, t[0], t[1], t[2]}, 1, size);
  }
}

TEST(ClosestVertexFace, SurvivesNeedlesAndCollapsedTriangles) {
  Numbers random;
  for (int i = 0; i < 20000; ++i) {
    const double width = i % 5 == 0 ? 0 : std::pow(10.0, -1.0 - i % 16);
    const Vec3 along = random.vec(), from = random.vec();
    const double s = random.unit();
    const std::array<Vec3, 3> t{from, from + along, from + s * along + width * random.vec()};
    const std::size_t turn = static_cast<std::size_t>(i % 3);
    const std::array<Vec3, 3> turned{t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]};
    const Vec3 p = i % 2 == 0 ? random.vec() : Vec3(from + random.unit() * along + width * random.vec());
    const ClosestPoints found = closest_vertex_face(p, turned[0], turned[1], turned[2]);
    EXPECT_NEAR(std::sqrt(found.distance_sq), exact_vertex_face(p, turned), 2e-13) << width;
    expect_consistent(found, {p, turned[0], turned[1], turned[2]}, 1, 4);
  }
  const Vec3 point{1, 2, 3};
  const ClosestPoints collapsed = closest_vertex_face({1, 2, 5}, point, point, point);
  EXPECT_EQ(collapsed.distance_sq, 4);
  EXPECT_EQ(collapsed.difference, Vec3(0, 0, 2));
}

TEST(ClosestVertexFace, DifferenceKeepsItsDirectionCloseToTheFace) {
  const Vec3 place{900, -400, 30};
  const Vec3 t0 = place, t1 = place + Vec3{0.0078125, 0, 0}, t2 = place + Vec3{0, 0.0078125, 0};
  // The point is 2^-33 m above a face at 1 km. All inputs are exactly representable, so only the function itself
  // rounds.
  const Vec3 p = place + Vec3{0.001953125, 0.001953125, 0x1p-33};
  const ClosestPoints found = closest_vertex_face(p, t0, t1, t2);
  EXPECT_EQ(found.difference, Vec3(0, 0, 0x1p-33));
  EXPECT_EQ(found.weights, (std::array<double, 4>{1, -0.5, -0.25, -0.25}));
}

TEST(ClosestEdgeEdge, IsInsideBothOrAtAnEndEitherSideOfEachBoundary) {
  const Vec3 p0{0, 0, 0}, p1{1, 0, 0};
  constexpr double s = 1e-12;
  struct Case {
    Vec3 q0, q1;
    unsigned support;  // bits 0 and 1: the ends of p; bits 2 and 3: those of q
  };
  const Case cases[] = {{{0.5, -1, 0.1}, {0.5, 1, 0.1}, 0b1111},     {{s, -1, 0.1}, {s, 1, 0.1}, 0b1111},
                        {{-s, -1, 0.1}, {-s, 1, 0.1}, 0b1101},       {{1 - s, -1, 0.1}, {1 - s, 1, 0.1}, 0b1111},
                        {{1 + s, -1, 0.1}, {1 + s, 1, 0.1}, 0b1110}, {{0.5, -s, 0.1}, {0.5, 1, 0.1}, 0b1111},
                        {{0.5, s, 0.1}, {0.5, 1, 0.1}, 0b0111},      {{0.5, -1, 0.1}, {0.5, -s, 0.1}, 0b1011},
                        {{-s, s, 0.1}, {-1, 1, 0.1}, 0b0101},        {{2, 0, 0}, {3, 0, 0}, 0b0110}};
  for (const Case& c : cases) {
    const ClosestPoints found = closest_edge_edge(p0, p1, c.q0, c.q1);
    EXPECT_EQ(found.support(), c.support) << c.q0.transpose() << " to " << c.q1.transpose();
    EXPECT_NEAR(std::sqrt(found.distance_sq), exact_edge_edge(p0, p1, c.q0, c.q1), 4e-16);
    expect_consistent(found, {p0, p1, c.q0, c.q1}, 2, 1);
  }
}

TEST(ClosestEdgeEdge, AgreesWithTheExactDistanceForEdgesOfEverySizeAndAngle) {
  Numbers random;
  for (int i = 0; i < 40000; ++i) {
    const double size = random.length(), angle = i % 4 == 0 ? 0 : std::pow(10.0, -(i % 18));
    const Vec3 place = random.vec() * 1000, d = random.vec() * size;
    const Vec3 p0 = place + random.vec() * size, q0 = place + random.vec() * size;
    const Vec3 p1 = p0 + d;
    const Vec3 q1 =
        q0 + (i % 7 == 0 ? Vec3(random.vec() * size) : Vec3(random.unit() * d + angle * size * random.vec()));
    const ClosestPoints found = closest_edge_edge(p0, p1, q0, q1);
    EXPECT_NEAR(std::sqrt(found.distance_sq), exact_edge_edge(p0, p1, q0, q1), 2e-13 * size) << angle;
    expect_consistent(found, {p0, p1, q0, q1}, 2, 4 * size);
  }
}

TEST(ClosestEdgeEdge, TakesPointsForEdges) {
  const Vec3 a{0, 0, 1}, b{0, 0, 0}, c{2, 0, 0};
  EXPECT_EQ(closest_edge_edge(a, a, b, c).distance_sq, 1);
  EXPECT_EQ(closest_edge_edge(b, c, a, a).distance_sq, 1);
  EXPECT_EQ(closest_edge_edge(a, a, c, c).distance_sq, 5);
  EXPECT_EQ(closest_edge_edge(a, a, a, a).distance_sq, 0);
}

}  // namespace
}  // namespace weft::collision
