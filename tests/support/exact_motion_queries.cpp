#include "support/exact_motion_queries.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "collision/hierarchy/feature_distance.hpp"

namespace weft::support {
namespace {

using Corners = std::array<Vec3, 3>;

struct Random {
  std::mt19937& engine;

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); }
  bool heads() { return whole(0, 1) == 1; }
  /// A number from 10^low to 10^high, logarithmically uniform.
  double decade(double low, double high) { return std::pow(10.0, between(low, high)); }
  Vec3 vector(double size = 1) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }
  /// Three integers of absolute value up to `size`.
  Vec3 grid(int size) {
    const int x = whole(-size, size), y = whole(-size, size), z = whole(-size, size);
    return {double(x), double(y), double(z)};
  }
  Vec3 unit() {
    for (;;) {
      const Vec3 v = vector();
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Corners corners() { return {vector(), vector(), vector()}; }
  /// Weights of three points, integer multiples of 1/16 that sum to 1; zeros are common.
  std::array<double, 3> weights() {
    const int u = heads() ? 0 : whole(0, 16), v = heads() ? 16 - u : whole(0, 16 - u);
    return {(16 - u - v) / 16.0, u / 16.0, v / 16.0};
  }
};

MovingSimplex still(const Corners& x) {
  return {3, x, x};
}

void move(MovingSimplex& s, const Vec3& by) {
  for (Vec3& x : s.t1) x += by;
}
void move_each(MovingSimplex& s, Random& random, double size) {
  for (Vec3& x : s.t1) x += random.vector(size);
}

template <class Change>
void for_all_points(MotionQuery& q, const Change& change) {
  for (MovingSimplex* s : {&q.a, &q.b}) {
    for (Vec3& x : s->t0) change(x);
    for (Vec3& x : s->t1) change(x);
  }
}

// Scales and shifts a query of size 1. With `exact`, coordinates that are multiples of 2⁻⁸ stay exact; otherwise they
// are rounded.
void place(MotionQuery& q, Random& random, bool exact) {
  double size = random.decade(-6, 3);
  Vec3 shift = random.heads() ? Vec3(random.vector(random.decade(-6, 3))) : Vec3(Vec3::Zero());
  if (exact) {
    size = std::ldexp(1.0, random.whole(-20, 5));
    shift = size * random.grid(random.heads() ? 0 : 1000);
  }
  for_all_points(q, [&](Vec3& x) { x = (size * x + shift).eval(); });
}

Vec3 mix(const std::array<double, 3>& w, const Corners& x) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
}

// --- Families, of size about 1 ---------------------------------------------------------------------------------------

MotionQuery random_query(Random& random) {
  MotionQuery q{still(random.corners()), still(random.corners())};
  const double motion = random.decade(-3, 0.5);
  move(q.a, random.vector(1.5));
  q.a.t0 = q.a.t1;
  move_each(q.a, random, motion);
  move_each(q.b, random, motion);
  return q;
}

// At t = 0, coordinates are multiples of 1/16 and the corners of b are integers, so that a point of a lies exactly on
// b.
MotionQuery touching_query(Random& random) {
  Corners b{random.grid(8), random.grid(8), random.grid(8)};
  const Vec3 contact = mix(random.weights(), b);
  const Vec3 n = (b[1] - b[0]).cross(b[2] - b[0]);  // exact
  const double side = random.heads() ? 1 : -1;
  const auto above = [&] {
    Vec3 v = random.grid(8);
    if (random.whole(0, 3) == 0) return v;  // on any side, so that a may cross the plane of b
    return side * n.dot(v) < 0 ? Vec3(-v) : v;
  };
  Corners a{contact, contact + above(), contact + above()};
  if (random.heads()) {  // the contact is on an edge of a instead of at a corner
    const Vec3 along = random.heads() ? Vec3(random.grid(4)) : Vec3(b[2] - b[1]);
    a = {contact - along, contact + along, contact + above()};
  }
  MotionQuery q{still(a), still(b)};
  switch (random.whole(0, 2)) {
    case 0:
      move(q.a, side * n / 64);
      break;
    case 1:
      move(q.a, random.grid(16) / 16);
      break;
    default: {
      for (MovingSimplex* s : {&q.a, &q.b})
        for (Vec3& x : s->t1) x += random.grid(16) / 16;
    }
  }
  return q;
}

// A unit vector perpendicular to two others, or the z axis if these are parallel.
Vec3 across(const Vec3& u, const Vec3& v) {
  const Vec3 n = u.cross(v);
  return n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
}

// A corner or edge of a at the distance `gap` above a point of b; all of a lies on that side of the face or edge.
MotionQuery close_query(Random& random, double gap) {
  Corners b = random.corners();
  const Vec3 n = across(b[1] - b[0], b[2] - b[0]);
  const auto above = [&](const Vec3& normal) {
    const Vec3 v = random.vector();
    return normal.dot(v) < 0 ? Vec3(-v) : v;
  };
  if (random.heads()) {
    const Vec3 at = mix(random.weights(), b) + gap * n;
    return {still({at, at + above(n), at + above(n)}), still(b)};
  }
  // An edge of a near an edge of b: both triangles extend away from the plane between the edges.
  const Vec3 along = random.vector(), m = across(b[1] - b[0], along);
  const Vec3 at = b[0] + random.between(0, 1) * (b[1] - b[0]);
  b[2] = at - above(m);
  return {still({at + gap * m - along, at + gap * m + along, at + gap * m + above(m)}), still(b)};
}

MotionQuery nearly_touching_query(Random& random) {
  MotionQuery q = close_query(random, 0);
  const double motion = random.decade(-6, 0);
  if (random.heads()) {
    move(q.a, random.vector(motion));
  } else {
    move_each(q.a, random, motion);
  }
  return q;
}

MotionQuery parallel_edges_query(Random& random) {
  const Vec3 along = random.grid(8) / 8, aside = random.grid(8) / 8;
  const double gap = random.heads() ? 0.125 : random.decade(-9, -1);
  const Vec3 p = random.grid(4) / 8, q0 = p + gap * aside + random.whole(-2, 2) * along / 2;
  MotionQuery q{still({p, p + along, p + random.vector()}), still({q0, q0 + along, q0 + random.vector()})};
  if (random.heads()) {
    move(q.a, random.heads() ? Vec3(aside * random.whole(1, 4) / 8) : random.vector(random.decade(-3, 0)));
  } else {
    move_each(q.a, random, random.decade(-6, 0));
  }
  return q;
}

MotionQuery one_plane_query(Random& random) {
  const Vec3 u = random.grid(8), v = random.grid(8);
  const auto in_plane = [&](int size) {
    return Vec3((random.whole(-size, size) * u + random.whole(-size, size) * v) / 16);
  };
  const Vec3 apart = in_plane(32) + (random.heads() ? Vec3(Vec3::Zero()) : Vec3(random.grid(2) / 64));
  MotionQuery q{still({in_plane(16), in_plane(16), in_plane(16)}),
                still({apart + in_plane(16), apart + in_plane(16), apart + in_plane(16)})};
  switch (random.whole(0, 3)) {
    case 0:
      move(q.a, in_plane(16));
      break;
    case 1:
      move(q.a, random.vector(random.decade(-4, 0)));
      break;
    case 2:
      move_each(q.a, random, random.decade(-4, 0));
      break;
    default: {
      for (MovingSimplex* s : {&q.a, &q.b})
        for (Vec3& x : s->t1) x += in_plane(8);
    }
  }
  return q;
}

Corners degenerate_corners(Random& random) {
  const Vec3 p = random.grid(16) / 16, along = random.grid(16) / 16;
  switch (random.whole(0, 2)) {
    case 0:
      return {p, p, p};
    case 1:
      return {p, p + along, p};
    default:
      return {p, p + along, p + random.whole(-2, 2) * along / 2};
  }
}

MotionQuery degenerate_query(Random& random) {
  MotionQuery q{still(degenerate_corners(random)),
                still(random.heads() ? degenerate_corners(random) : random.corners())};
  if (random.heads()) std::swap(q.a, q.b);
  switch (random.whole(0, 2)) {
    case 0:
      move(q.a, random.grid(32) / 16);
      break;
    case 1:
      move_each(q.a, random, random.decade(-3, 0.3));
      break;
    default:
      q.a.t1 = degenerate_corners(random);  // a becomes degenerate
  }
  return q;
}

MotionQuery needle_query(Random& random) {
  const auto needle = [&](double thickness) -> Corners {
    const Vec3 p = random.vector(), along = random.vector();
    return {p, p + along, p + random.between(-0.5, 1.5) * along + random.vector(thickness)};
  };
  MotionQuery q{still(needle(random.decade(-9, -3))),
                still(random.heads() ? needle(random.decade(-9, -3)) : random.corners())};
  const double motion = random.decade(-4, 0.3);
  if (random.heads()) move_each(q.a, random, motion);
  move(q.b, random.vector(motion));
  return q;
}

// Gap and motion are in metres: they do not scale with the size.
MotionQuery near_miss_query(Random& random) {
  const double size = random.decade(-2, 1), gap = random.decade(-9, -3), motion = gap * random.decade(-1, 1);
  MotionQuery q = close_query(random, gap / size);
  const Vec3 shift = random.heads() ? Vec3(random.vector(random.decade(-3, 3))) : Vec3(Vec3::Zero());
  for_all_points(q, [&](Vec3& x) { x = (size * x + shift).eval(); });
  const Vec3 common = random.heads() ? Vec3(random.vector()) : Vec3(Vec3::Zero());
  for (MovingSimplex* s : {&q.a, &q.b}) {
    move(*s, common);
    move_each(*s, random, motion / std::sqrt(3.0));
  }
  return q;
}

MotionQuery fast_query(Random& random) {
  MotionQuery q{still(random.corners()), still(random.corners())};
  const Vec3 displacement = random.decade(1, 3) * random.unit();
  const double when = random.between(0, 1.2);
  for (Vec3& x : q.a.t0) x += random.vector(0.1) - when * displacement;
  for (Vec3& x : q.a.t1) x += random.vector(0.1) + (1 - when) * displacement;
  move_each(q.b, random, random.decade(-3, 0));
  return q;
}

MotionQuery grazing_rotation_query(Random& random) {
  const double gap = random.heads() ? 0 : random.decade(-9, -1);
  MotionQuery q = close_query(random, gap);
  // Triangle a rotates about a point near one of its corners. At `fraction` of the motion it comes close to its
  // position beside b; if `fraction` is negative, the motion starts beyond this position.
  const Vec3 centre = q.a.t0[random.whole(0, 2)] + random.vector(random.decade(-3, 0));
  const Vec3 axis = random.unit();
  const double angle = random.decade(-3, 0) * std::numbers::pi, fraction = random.between(-0.2, 1);
  const Corners at = q.a.t0;
  for (std::size_t k = 0; k < 3; ++k) {
    q.a.t0[k] = centre + Eigen::AngleAxisd(-fraction * angle, axis) * (at[k] - centre);
    q.a.t1[k] = centre + Eigen::AngleAxisd((1 - fraction) * angle, axis) * (at[k] - centre);
  }
  if (random.heads()) move(q.b, random.vector(random.decade(-4, -1)));
  return q;
}

/// How often a query has exact coordinates.
enum class Exact { never, half, always };

/// By QueryFamily.
struct Family {
  const char* name;
  MotionQuery (*make)(Random& random);
  Exact exact;
};
constexpr Family kFamilies[] = {{"random", random_query, Exact::never},
                                {"touching", touching_query, Exact::always},
                                {"nearly touching", nearly_touching_query, Exact::never},
                                {"parallel edges", parallel_edges_query, Exact::half},
                                {"one plane", one_plane_query, Exact::half},
                                {"degenerate", degenerate_query, Exact::half},
                                {"needles", needle_query, Exact::never},
                                {"near misses", near_miss_query, Exact::never},
                                {"fast", fast_query, Exact::never},
                                {"grazing rotation", grazing_rotation_query, Exact::never}};
static_assert(std::size(kFamilies) == kQueryFamilies.size());

}  // namespace

const char* name(QueryFamily family) {
  return kFamilies[static_cast<std::size_t>(family)].name;
}

MotionQuery make_query(QueryFamily family, std::mt19937& engine) {
  Random random{engine};
  const Family& made = kFamilies[static_cast<std::size_t>(family)];
  MotionQuery q = made.make(random);
  if (family == QueryFamily::near_misses) return q;
  place(q, random, made.exact == Exact::always || (made.exact == Exact::half && random.heads()));
  return q;
}

double distance_at(const MovingSimplex& a, const MovingSimplex& b, double t) {
  // An edge counts as a triangle whose second end occurs twice.
  std::vector<Vec3> x;
  for (const MovingSimplex* s : {&a, &b})
    for (int k = 0; k < 3; ++k) {
      const int corner = std::min(k, s->count - 1);
      x.emplace_back((1 - t) * s->t0[corner] + t * s->t1[corner]);
    }
  return collision::testing::feature_distance({0, 1, 2}, {3, 4, 5}, x);
}

}  // namespace weft::support
