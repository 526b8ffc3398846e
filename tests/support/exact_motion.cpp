#include "support/exact_motion.hpp"

// GCC 12 warns of a use after free where CGAL releases a reference-counted number.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <CGAL/Algebraic_kernel_d_1.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpz.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

// If two simplices are apart at t = 0, their first contact is between a vertex and a face or between two edges. It may
// also be between a vertex and an edge or between two vertices if faces or edges are degenerate or edges are parallel.
// Each contact is a set of conditions on polynomials of at most fourth degree: some vanish, some are ≥ 0, one is > 0.
// Interval arithmetic tests the conditions first; integer arithmetic decides those that remain uncertain. If the
// simplices cross from the start, the contact is found at t = 0.
namespace weft::support {
namespace {

using Interval = CGAL::Interval_nt_advanced;
using Integer = CGAL::Gmpz;
using Roots = CGAL::Algebraic_kernel_d_1<Integer>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr std::size_t kMaxDegree = 4;

/// The polynomial Σ c[i] t^i (1 − t)^(degree − i), a Bernstein form without binomial factors. If all c have one sign,
/// the polynomial has this sign in all of [0, 1]. The coefficients of a product are the convolution of those of the
/// factors. With z = t / (1 − t), the zeros are those of Σ c[i] z^i.
template <class N>
struct Polynomial {
  std::size_t degree = 0;
  std::array<N, kMaxDegree + 1> c;
  const N& at_start() const { return c[0]; }
  const N& at_end() const { return c[degree]; }
};

template <class N>
Polynomial<N> combine(const Polynomial<N>& p, const Polynomial<N>& q, bool subtract) {
  Polynomial<N> result{p.degree, {}};
  for (std::size_t i = 0; i <= p.degree; ++i) result.c[i] = subtract ? p.c[i] - q.c[i] : p.c[i] + q.c[i];
  return result;
}
template <class N>
Polynomial<N> operator-(const Polynomial<N>& p, const Polynomial<N>& q) {
  return combine(p, q, true);
}
template <class N>
Polynomial<N> operator+(const Polynomial<N>& p, const Polynomial<N>& q) {
  return combine(p, q, false);
}
template <class N>
Polynomial<N> operator*(const Polynomial<N>& p, const Polynomial<N>& q) {
  Polynomial<N> result{p.degree + q.degree, {}};
  for (std::size_t i = 0; i <= result.degree; ++i) result.c[i] = N(0);
  for (std::size_t i = 0; i <= p.degree; ++i)
    for (std::size_t j = 0; j <= q.degree; ++j) result.c[i + j] += p.c[i] * q.c[j];
  return result;
}

/// A moving point or vector.
template <class N>
using Path = std::array<Polynomial<N>, 3>;

template <class N>
Path<N> operator-(const Path<N>& p, const Path<N>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
template <class N>
Polynomial<N> dot(const Path<N>& p, const Path<N>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
template <class N>
Path<N> cross(const Path<N>& p, const Path<N>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

int sure_sign(const Interval& x) {
  return x.inf() > 0 ? 1 : x.sup() < 0 ? -1 : 0;
}
int sure_sign(const Integer& x) {
  return CGAL::sign(x);
}
bool surely_zero(const Interval& x) {
  return x.inf() == 0 && x.sup() == 0;
}
bool surely_zero(const Integer& x) {
  return CGAL::is_zero(x);
}

/// Common sign of all coefficients; 0 if they differ or one is uncertain.
template <class N>
int common_sign(const Polynomial<N>& p) {
  const int sign = sure_sign(p.c[0]);
  for (std::size_t i = 1; i <= p.degree; ++i)
    if (sure_sign(p.c[i]) != sign) return 0;
  return sign;
}

/// Conditions for contact: all of `zero` vanish, none of `not_negative` is below zero, `positive` is above zero.
template <class N>
struct Conditions {
  bool impossible = false;  ///< one of `zero` has no root in [0, 1]; the rest may be missing
  std::vector<Polynomial<N>> zero, not_negative;
  Polynomial<N> positive;

  void require_zero(const Polynomial<N>& p) {
    impossible = impossible || common_sign(p) != 0;
    zero.push_back(p);
  }
};

/// Conditions for p to lie in the non-degenerate face a b c.
template <class N>
Conditions<N> vertex_face(const Path<N>& p, const Path<N>& a, const Path<N>& b, const Path<N>& c) {
  const Path<N> ab = b - a, ac = c - a, ap = p - a;
  const Path<N> n = cross(ab, ac);
  Conditions<N> k;
  k.require_zero(dot(n, ap));
  if (k.impossible) return k;
  // Barycentric coordinates times |n|².
  k.not_negative = {dot(n, cross(ab, ap)), dot(n, cross(ap, ac)), dot(n, cross(c - b, p - b))};
  k.positive = dot(n, n);
  return k;
}

/// Conditions for the non-parallel edges p q and a b to cross.
template <class N>
Conditions<N> edge_edge(const Path<N>& p, const Path<N>& q, const Path<N>& a, const Path<N>& b) {
  const Path<N> d = q - p, e = b - a, w = a - p;
  const Path<N> n = cross(d, e);
  Conditions<N> k;
  k.require_zero(dot(n, w));
  if (k.impossible) return k;
  // Parameters of the crossing on the edges, times |n|².
  const Polynomial<N> on_pq = dot(n, cross(w, e)), on_ab = dot(n, cross(w, d));
  k.positive = dot(n, n);
  k.not_negative = {on_pq, k.positive - on_pq, on_ab, k.positive - on_ab};
  return k;
}

/// Conditions for p to lie on the edge a b, which has a positive length.
template <class N>
Conditions<N> vertex_edge(const Path<N>& p, const Path<N>& a, const Path<N>& b) {
  const Path<N> e = b - a, ap = p - a;
  Conditions<N> k;
  for (const Polynomial<N>& component : cross(e, ap)) k.require_zero(component);
  if (k.impossible) return k;
  k.not_negative = {dot(e, ap), dot(e, b - p)};
  k.positive = dot(e, e);
  return k;
}

template <class N>
Conditions<N> vertex_vertex(const Path<N>& p, const Path<N>& a) {
  Conditions<N> k;
  for (const Polynomial<N>& component : p - a) k.require_zero(component);
  k.positive = {0, {N(1)}};
  return k;
}

/// A feature of each simplex: corners of one and corners of the other, as indices in the list of all points.
struct Feature {
  enum Kind { kVertexFace, kEdgeEdge, kVertexEdge, kVertexVertex } kind;
  std::vector<std::size_t> a, b;
};

template <class N>
Conditions<N> conditions(const Feature& f, const std::vector<Path<N>>& x) {
  switch (f.kind) {
    case Feature::kVertexFace:
      return vertex_face(x[f.a[0]], x[f.b[0]], x[f.b[1]], x[f.b[2]]);
    case Feature::kEdgeEdge:
      return edge_edge(x[f.a[0]], x[f.a[1]], x[f.b[0]], x[f.b[1]]);
    case Feature::kVertexEdge:
      return vertex_edge(x[f.a[0]], x[f.b[0]], x[f.b[1]]);
    case Feature::kVertexVertex:
      return vertex_vertex(x[f.a[0]], x[f.b[0]]);
  }
  throw std::logic_error("no such kind of feature");
}

std::vector<std::vector<std::size_t>> edges_of(std::size_t first, std::size_t count) {
  if (count == 2) return {{first, first + 1}};
  return {{first, first + 1}, {first + 1, first + 2}, {first + 2, first}};
}

// All pairs of a feature of the points 0 .. na − 1 and one of the points na .. na + nb − 1. The kinds of pairs that
// find most contacts come first.
std::vector<Feature> make_features(std::size_t na, std::size_t nb) {
  std::vector<Feature> list;
  for (std::size_t i = 0; i < na && nb == 3; ++i) list.push_back({Feature::kVertexFace, {i}, {na, na + 1, na + 2}});
  for (std::size_t j = na; j < na + nb && na == 3; ++j) list.push_back({Feature::kVertexFace, {j}, {0, 1, 2}});
  const auto edges_a = edges_of(0, na), edges_b = edges_of(na, nb);
  for (const auto& e : edges_a)
    for (const auto& f : edges_b) list.push_back({Feature::kEdgeEdge, e, f});
  for (const auto& e : edges_a)
    for (std::size_t j = na; j < na + nb; ++j) list.push_back({Feature::kVertexEdge, {j}, e});
  for (const auto& e : edges_b)
    for (std::size_t i = 0; i < na; ++i) list.push_back({Feature::kVertexEdge, {i}, e});
  for (std::size_t i = 0; i < na; ++i)
    for (std::size_t j = na; j < na + nb; ++j) list.push_back({Feature::kVertexVertex, {i}, {j}});
  return list;
}

const std::vector<Feature>& features(int na, int nb) {
  static const std::vector<Feature> both = make_features(3, 3), left = make_features(2, 3), right = make_features(3, 2),
                                    edges = make_features(2, 2);
  return na == 3 ? nb == 3 ? both : right : nb == 3 ? left : edges;
}

// --- Interval arithmetic ---------------------------------------------------------------------------------------------

enum class Answer { apart, touch, unknown };

/// The conditions on a part of [0, 1], in Bernstein form: coefficients are divided by the binomial coefficients, as de
/// Casteljau's algorithm needs.
struct Subinterval {
  Conditions<Interval> conditions;
  double begin, width;
};

void to_bernstein(Polynomial<Interval>& p) {
  static constexpr double kBinomial[kMaxDegree + 1][kMaxDegree + 1] = {
      {1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
  for (std::size_t i = 0; i <= p.degree; ++i) p.c[i] /= Interval(kBinomial[p.degree][i]);
}

template <class Change>
void for_all(Conditions<Interval>& k, const Change& change) {
  for (auto& p : k.zero) change(p);
  for (auto& p : k.not_negative) change(p);
  change(k.positive);
}

void keep_half(Polynomial<Interval>& p, bool second) {
  for (std::size_t round = 1; round <= p.degree; ++round) {
    if (second) {
      for (std::size_t i = 0; i + round <= p.degree; ++i) p.c[i] = (p.c[i] + p.c[i + 1]) * 0.5;
    } else {
      for (std::size_t i = p.degree; i >= round; --i) p.c[i] = (p.c[i - 1] + p.c[i]) * 0.5;
    }
  }
}

Subinterval half_of(Subinterval part, bool second) {
  for_all(part.conditions, [&](Polynomial<Interval>& p) { keep_half(p, second); });
  part.width *= 0.5;
  if (second) part.begin += part.width;
  return part;
}

bool surely_apart(const Conditions<Interval>& k) {
  return std::any_of(k.zero.begin(), k.zero.end(), [](const auto& p) { return common_sign(p) != 0; }) ||
         std::any_of(k.not_negative.begin(), k.not_negative.end(), [](const auto& p) { return common_sign(p) < 0; });
}

// Whether contact is certain: one equation changes its sign and all other conditions hold strictly throughout, or all
// hold at the beginning.
bool surely_touching(const Conditions<Interval>& k) {
  const auto throughout = [](const auto& p) { return common_sign(p) > 0; };
  const auto at_start = [](const auto& p) { return sure_sign(p.at_start()) > 0; };
  const auto zero_at_start = [](const auto& p) { return surely_zero(p.at_start()); };
  if (std::all_of(k.zero.begin(), k.zero.end(), zero_at_start) && at_start(k.positive) &&
      std::all_of(k.not_negative.begin(), k.not_negative.end(), at_start))
    return true;
  return k.zero.size() == 1 && sure_sign(k.zero[0].at_start()) * sure_sign(k.zero[0].at_end()) < 0 &&
         std::all_of(k.not_negative.begin(), k.not_negative.end(), throughout) && throughout(k.positive);
}

// A time of contact, up to rounding, in a subinterval that certainly has one.
double bisect_to_contact(Subinterval part) {
  while (part.width > 1e-16 && sure_sign(part.conditions.zero[0].at_start()) != 0) {
    const Subinterval first = half_of(part, false);
    const auto& e = first.conditions.zero[0];
    if (sure_sign(e.at_end()) == 0) return first.begin + first.width;
    part = sure_sign(e.at_start()) != sure_sign(e.at_end()) ? first : half_of(part, true);
  }
  return part.begin;
}

Answer test_intervals(Conditions<Interval> k, double& time) {
  constexpr int kMaxSubintervals = 64;  // a root needs two subintervals per bit; beyond 2⁻³⁰ integers are faster
  if (k.impossible) return Answer::apart;
  for_all(k, to_bernstein);
  std::vector<Subinterval> parts{{std::move(k), 0, 1}};
  for (int count = 0; !parts.empty(); ++count) {
    const Subinterval part = std::move(parts.back());
    parts.pop_back();
    if (surely_apart(part.conditions)) continue;
    if (surely_touching(part.conditions)) {
      time = bisect_to_contact(part);
      return Answer::touch;
    }
    if (count >= kMaxSubintervals) return Answer::unknown;
    parts.push_back(half_of(part, true));
    parts.push_back(half_of(part, false));
  }
  return Answer::apart;
}

// --- Integers --------------------------------------------------------------------------------------------------------

template <class Sign>
bool fulfilled(const Conditions<Integer>& k, const Sign& sign) {
  return std::all_of(k.zero.begin(), k.zero.end(), [&](const auto& p) { return sign(p) == 0; }) &&
         sign(k.positive) > 0 &&
         std::all_of(k.not_negative.begin(), k.not_negative.end(), [&](const auto& p) { return sign(p) >= 0; });
}

bool vanishes(const Polynomial<Integer>& p) {
  return std::all_of(p.c.begin(), p.c.begin() + static_cast<std::ptrdiff_t>(p.degree) + 1,
                     [](const Integer& c) { return surely_zero(c); });
}

Roots::Polynomial_1 in_z(const Polynomial<Integer>& p) {
  return {p.c.begin(), p.c.begin() + static_cast<std::ptrdiff_t>(p.degree) + 1};
}

// A time at which all conditions hold. If all of `zero` vanish identically, contact exists at t = 0, or begins where
// another condition reaches zero. The latter is a contact of simpler features. Since these are tested as well, this
// function does not look for it.
std::optional<double> decide(const Conditions<Integer>& k) {
  if (k.impossible) return {};
  if (fulfilled(k, [](const auto& p) { return sure_sign(p.at_start()); })) return 0.0;
  if (fulfilled(k, [](const auto& p) { return sure_sign(p.at_end()); })) return 1.0;
  const auto equation = std::find_if_not(k.zero.begin(), k.zero.end(), vanishes);
  if (equation == k.zero.end()) return {};

  const Roots roots;
  std::vector<Roots::Algebraic_real_1> z_list;
  roots.solve_1_object()(in_z(*equation), false, std::back_inserter(z_list));
  for (const Roots::Algebraic_real_1& z : z_list) {
    if (CGAL::sign(z) <= 0) continue;
    const auto sign = [&](const Polynomial<Integer>& p) -> int {
      return vanishes(p) ? 0 : static_cast<int>(roots.sign_at_1_object()(in_z(p), z));
    };
    if (!fulfilled(k, sign)) continue;
    const double approximate = CGAL::to_double(roots.approximate_absolute_1_object()(z, 60).first);
    return approximate / (1 + approximate);
  }
  return {};
}

// --- Points ----------------------------------------------------------------------------------------------------------

// Paths relative to the moving first point of a, so that the distance from the origin costs no digits. Each difference
// is rounded once.
std::vector<Path<Interval>> interval_paths(const MovingSimplex& a, const MovingSimplex& b) {
  std::vector<Path<Interval>> paths;
  for (const MovingSimplex* s : {&a, &b}) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(s->count); ++i) {
      Path<Interval>& path = paths.emplace_back();
      for (int d = 0; d < 3; ++d) {
        path[d] = {1, {Interval(s->t0[i][d]) - Interval(a.t0[0][d]), Interval(s->t1[i][d]) - Interval(a.t1[0][d])}};
      }
    }
  }
  return paths;
}

// x · 2^shift, which must be an integer.
Integer scaled(double x, int shift) {
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(x, &exponent), 53);  // an integer
  const int left = exponent - 53 + shift;
  if (mantissa == 0) return Integer(0);
  return left >= 0 ? Integer(mantissa) << left : Integer(std::ldexp(mantissa, left));
}

std::vector<Path<Integer>> integer_paths(const MovingSimplex& a, const MovingSimplex& b) {
  int shift = 0;  // makes every coordinate an integer; contact does not depend on the scale
  for (const MovingSimplex* s : {&a, &b}) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(s->count); ++i) {
      for (int d = 0; d < 3; ++d) {
        for (double x : {s->t0[i][d], s->t1[i][d]})
          if (x != 0) shift = std::max(shift, 53 - 1 - std::ilogb(x));
      }
    }
  }
  std::vector<Path<Integer>> paths;
  for (const MovingSimplex* s : {&a, &b}) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(s->count); ++i) {
      Path<Integer>& path = paths.emplace_back();
      for (int d = 0; d < 3; ++d) path[d] = {1, {scaled(s->t0[i][d], shift), scaled(s->t1[i][d], shift)}};
    }
  }
  return paths;
}

// Whether the boxes around the swept paths of a and b are disjoint.
bool boxes_apart(const std::vector<const Vec3*>& a, const std::vector<const Vec3*>& b) {
  for (int d = 0; d < 3; ++d) {
    const auto less = [d](const Vec3* p, const Vec3* q) { return (*p)[d] < (*q)[d]; };
    const auto [low_a, high_a] = std::minmax_element(a.begin(), a.end(), less);
    const auto [low_b, high_b] = std::minmax_element(b.begin(), b.end(), less);
    if (less(*high_a, *low_b) || less(*high_b, *low_a)) return true;
  }
  return false;
}

// Start and end positions of the selected points.
std::vector<const Vec3*> ends(const std::vector<std::size_t>& points, const MovingSimplex& a, const MovingSimplex& b) {
  std::vector<const Vec3*> list;
  for (std::size_t i : points) {
    const auto na = static_cast<std::size_t>(a.count);
    const MovingSimplex& s = i < na ? a : b;
    const std::size_t k = i < na ? i : i - na;
    list.push_back(&s.t0[k]);
    list.push_back(&s.t1[k]);
  }
  return list;
}

// Whether an edge of a pierces the triangle b at the start. The ends of such an edge are on different sides of b's
// plane, or one of them is in it.
bool pierces_at_start(const MovingSimplex& a, const MovingSimplex& b) {
  if (b.count != 3) return false;
  const auto point = [](const Vec3& x) { return Kernel::Point_3(x.x(), x.y(), x.z()); };
  const std::array<Kernel::Point_3, 3> t{point(b.t0[0]), point(b.t0[1]), point(b.t0[2])};
  for (const auto& e : edges_of(0, static_cast<std::size_t>(a.count))) {
    const Kernel::Point_3 p = point(a.t0[e[0]]), q = point(a.t0[e[1]]);
    if (CGAL::orientation(t[0], t[1], t[2], p) == CGAL::orientation(t[0], t[1], t[2], q)) continue;
    const int sides[] = {CGAL::orientation(p, q, t[0], t[1]), CGAL::orientation(p, q, t[1], t[2]),
                         CGAL::orientation(p, q, t[2], t[0])};
    const auto [low, high] = std::minmax_element(std::begin(sides), std::end(sides));
    if (*low >= 0 || *high <= 0) return true;
  }
  return false;
}

}  // namespace

MovingSimplex MovingSimplex::edge_opposite(int corner) const {
  const auto i = static_cast<std::size_t>((corner + 1) % 3), j = static_cast<std::size_t>((corner + 2) % 3);
  return {2, {t0[i], t0[j], Vec3::Zero()}, {t1[i], t1[j], Vec3::Zero()}};
}

Contact find_contact(const MovingSimplex& a, const MovingSimplex& b) {
  if (pierces_at_start(a, b) || pierces_at_start(b, a)) return {true, 0, false};

  std::vector<const Feature*> open;
  {
    const CGAL::Protect_FPU_rounding<true> upwards;
    const std::vector<Path<Interval>> paths = interval_paths(a, b);
    for (const Feature& feature : features(a.count, b.count)) {
      if (boxes_apart(ends(feature.a, a, b), ends(feature.b, a, b))) continue;
      double time = -1;
      const Answer answer = test_intervals(conditions(feature, paths), time);
      if (answer == Answer::touch) return {true, time, false};
      if (answer == Answer::unknown) open.push_back(&feature);
    }
  }
  if (open.empty()) return {};
  const std::vector<Path<Integer>> paths = integer_paths(a, b);
  for (const Feature* feature : open) {
    if (const auto time = decide(conditions(*feature, paths))) return {true, *time, true};
  }
  return {false, -1, true};
}

Contact find_contact_beside_shared(const MovingSimplex& a, int i, const MovingSimplex& b, int j) {
  const Contact first = find_contact(a.edge_opposite(i), b);
  if (first.found) return first;
  Contact second = find_contact(a, b.edge_opposite(j));
  second.integers_used = second.integers_used || first.integers_used;
  return second;
}

}  // namespace weft::support
