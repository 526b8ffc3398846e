#include "physics/forces/stretch_limit.hpp"

#include <cmath>

#include "core/parallel_append.hpp"

namespace weft::forces {
namespace {

// A piece needs some stiffness below the onset, so that find_extension() has a unique solution.
// This minimum affects only the linearisation, not the solution of the step.
StretchParameters with_min_stiffness(StretchParameters below) {
  constexpr double kMinStiffness = 1;  // [N/m]
  below.weft = std::max(below.weft, kMinStiffness), below.warp = std::max(below.warp, kMinStiffness);
  return below;
}

// Bounds of Newton's method in find_extension: iterations, and residual relative to the tension.
constexpr int kMaxExtensionIterations = 20;
constexpr double kExtensionTolerance = 1e-3;

// Returns the extension at which cloth and lock together have the tension `tension` [N/m], up to
// kExtensionTolerance. `e`: initial guess, at which the tension must be at least `tension`. From
// there, Newton's method converges monotonically, as the tension is a convex function of the
// extension.
double find_extension(const Lock& lock, double stiffness, double tension, double e) {
  if (tension <= stiffness * lock.onset()) return tension / stiffness;
  for (int k = 0; k < kMaxExtensionIterations; ++k) {
    const double excess = stiffness * e + lock.stress(e) - tension;
    if (excess <= kExtensionTolerance * tension) break;
    e -= excess / (stiffness + lock.stiffness(e));
  }
  return e;
}

}  // namespace

StretchLimit::StretchLimit(const mesh::Grid& grid, Index first, const StretchParameters& below, double stretch,
                           double shear)
    : below_(with_min_stiffness(below)), stretch_(stretch), shear_(shear) {
  const bool limited = !std::isinf(stretch);
  const auto add_thread = [&](Index i, Index j, double length, double width, double stiffness) {
    threads_.push_back({2, {first + i, first + j}, {-1 / length, 1 / length}, width * length, stiffness});
  };
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) {
      const Index here = grid.index(i, j);
      const bool weft = i + 1 < grid.nu, warp = j + 1 < grid.nv;
      if (weft && limited) add_thread(here, grid.index(i + 1, j), grid.du(i), grid.width_v(j), below_.weft);
      if (warp && limited) add_thread(here, grid.index(i, j + 1), grid.dv(j), grid.width_u(i), below_.warp);
      if (!weft || !warp || std::isinf(shear)) continue;
      const double u = 0.5 / grid.du(i), v = 0.5 / grid.dv(j);
      const Corners corners{first + here, first + grid.index(i + 1, j), first + grid.index(i, j + 1),
                            first + grid.index(i + 1, j + 1)};
      crossings_.push_back({4, corners, {-u, u, -u, u}, {-v, -v, v, v}, grid.du(i) * grid.dv(j)});
    }
  threads_.shrink_to_fit();
  crossings_.shrink_to_fit();
}

StretchLimit::StretchLimit(const TriangleMembrane& membrane, const StretchParameters& below, double stretch,
                           double shear)
    : below_(with_min_stiffness(below)), stretch_(stretch), shear_(shear) {
  copy_rest_shape(membrane);
}

void StretchLimit::copy_rest_shape(const TriangleMembrane& membrane) {
  threads_.clear(), crossings_.clear();
  for (const TriangleMembrane::Element& element : membrane.elements()) {
    const auto& [a, b, c] = element.particles;
    const auto& g = element.gradients;
    if (!std::isinf(stretch_)) {
      threads_.push_back({3, {a, b, c}, {g[0].x(), g[1].x(), g[2].x()}, element.area, below_.weft});
      threads_.push_back({3, {a, b, c}, {g[0].y(), g[1].y(), g[2].y()}, element.area, below_.warp});
    }
    if (!std::isinf(shear_))
      crossings_.push_back(
          {3, {a, b, c}, {g[0].x(), g[1].x(), g[2].x()}, {g[0].y(), g[1].y(), g[2].y()}, element.area});
  }
}

void StretchLimit::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Thread& thread : threads_) append_pairs_of(std::span(thread.particles).first(thread.corners), pairs);
  for (const Crossing& c : crossings_) append_pairs_of(std::span(c.particles).first(c.corners), pairs);
}

template <class Piece, class OfCorners>
Vec3 StretchLimit::derivative(const Piece& piece, const OfCorners& weights, std::span<const Vec3> x) {
  Vec3 s = Vec3::Zero();
  for (std::size_t k = 0; k < piece.corners; ++k) s += weights[k] * x[piece.particles[k]];
  return s;
}

template <class Piece, class OfCorners>
Vec3 StretchLimit::derivative(const Piece& piece, const OfCorners& weights,
                              std::span<const solver::PaddedVec3<double>> x) {
  solver::PaddedVec3<double> s{};
  for (std::size_t k = 0; k < piece.corners; ++k) s += weights[k] * x[piece.particles[k]];
  return solver::vec3_of(s);
}

// Calls body(piece, corner_forces, block_of) for each crossing that is beyond its onset at x, and for each piece of a
// thread whose exact or linearised stress at x is positive. block_of(a, b) returns the block of −∂f/∂x for corners a
// and b. Threads are linearised at the extensions in `linearisation` or, if `linearisation` is null, at x. Crossings
// are linearised at x. For `exact` see lock().
template <class Points, class Body>
void StretchLimit::for_each_lock(Points x, std::size_t range, bool exact, const LockLinearisation* linearisation,
                                 const Body& body) const {
  // Nearly all pieces are below the onset; comparing squared lengths saves their square roots.
  const double onset = 1 + Lock(stretch_).onset(), onset_sq = onset * onset;
  ranges_of_threads_.for_each(range, threads_.size(), [&](std::size_t t) {
    const Vec3 s = derivative(threads_[t], threads_[t].along, x);
    const double* at = linearisation != nullptr ? &linearisation->extensions[t] : nullptr;
    if (s.squaredNorm() <= onset_sq && (at == nullptr || *at <= onset - 1)) return;
    lock(threads_[t], s, at,
         [&](const CornerForces& corner_forces, const auto& block_of) { body(threads_[t], corner_forces, block_of); });
  });
  const double shear_onset = Lock(shear_).onset();
  ranges_of_crossings_.for_each(range, crossings_.size(), [&](std::size_t c) {
    const Crossing& crossing = crossings_[c];
    const Vec3 s_u = derivative(crossing, crossing.weft, x), s_v = derivative(crossing, crossing.warp, x);
    if (!(std::abs(s_u.dot(s_v)) > shear_onset)) return;
    lock(crossing, s_u, s_v, exact,
         [&](const CornerForces& corner_forces, const auto& block_of) { body(crossing, corner_forces, block_of); });
  });
}

void StretchLimit::partition(std::span<const Index> bounds) {
  const auto cut_pieces = [&](const auto& pieces, Ranges& ranges) {
    ranges.partition(bounds, pieces.size(), [&](std::size_t p, const auto& visit) {
      for (std::size_t k = 0; k < pieces[p].corners; ++k) visit(pieces[p].particles[k]);
    });
  };
  cut_pieces(threads_, ranges_of_threads_);
  cut_pieces(crossings_, ranges_of_crossings_);
}

void StretchLimit::add(const Evaluation& at) const {
  for_each_lock(at.x, at.range, false, at.assembly ? at.locks : nullptr,
                [&](const auto& piece, const CornerForces& corner_forces, const auto& block_of) {
                  for (std::size_t k = 0; k < piece.corners; ++k)
                    at.force.subtract(piece.particles[k], solver::padded<double>(corner_forces[k]));
                  if (!at.assembly) return;
                  for (std::size_t a = 0; a < piece.corners; ++a)
                    for (std::size_t b = 0; b < piece.corners; ++b)
                      if (piece.particles[a] < piece.particles[b])
                        at.assembly.add(at.assembly.block(piece.particles[a], piece.particles[b]), block_of(a, b));
                });
}

void StretchLimit::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> /*v*/, double /*rate*/,
                                solver::BlockMatrix& jacobian) const {
  for_each_lock(x, Evaluation::kAll, true, nullptr, [&](const auto& piece, const CornerForces&, const auto& block_of) {
    for (std::size_t a = 0; a < piece.corners; ++a)
      for (std::size_t b = 0; b < piece.corners; ++b)
        jacobian.add(jacobian.slot(piece.particles[a], piece.particles[b]), block_of(a, b));
  });
}

StretchLimit::Tangent StretchLimit::tangent(double linearised_at, double e) const {
  const Lock lock(stretch_);
  const double stiffness = lock.stiffness(linearised_at),
               stress = lock.stress(linearised_at) + stiffness * (e - linearised_at);
  return stress > 0 ? Tangent{stress, stiffness} : Tangent{0, 0};
}

// The block is positive semidefinite without clamping, as a lock acts only in tension.
template <class Body>
void StretchLimit::lock(const Thread& piece, const Vec3& s, const double* linearised_at, const Body& body) const {
  const double length = s.norm(), e = length - 1, stress = piece.area * Lock(stretch_).stress(e);
  const Tangent linear = tangent(linearised_at != nullptr ? *linearised_at : e, e);
  if (stress == 0 && linear.stress == 0) return;  // includes pieces of length 0
  const Vec3 n = s / length;
  CornerForces corner_forces{};
  for (std::size_t k = 0; k < piece.corners; ++k) corner_forces[k] = stress * piece.along[k] * n;
  const double lateral = piece.area * linear.stress / length, axial = piece.area * linear.stiffness;
  body(corner_forces, [&](std::size_t a, std::size_t b) -> Mat3 {
    return piece.along[a] * piece.along[b] * ((axial - lateral) * n * n.transpose() + lateral * Mat3::Identity());
  });
}

void StretchLimit::begin(std::span<const Vec3> x, LockLinearisation& linearisation) const {
  linearisation.extensions.resize(threads_.size());
  parallel_for(threads_.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      linearisation.extensions[t] = derivative(threads_[t], threads_[t].along, x).norm() - 1;
  });
}

void StretchLimit::update(std::span<const Vec3> x, bool first, LockLinearisation& linearisation) const {
  const Lock lock(stretch_);
  const double onset = lock.onset(), onset_sq = (1 + onset) * (1 + onset);
  linearisation.beyond_onset.clear();
  parallel_append(threads_.size(), kGrainSize, linearisation.beyond_onset,
                  [&](std::size_t begin, std::size_t end, auto& pieces) {
                    for (std::size_t t = begin; t < end; ++t) {
                      const double length_sq = derivative(threads_[t], threads_[t].along, x).squaredNorm();
                      double& at = linearisation.extensions[t];
                      if (length_sq <= onset_sq && at <= onset) continue;
                      pieces.push_back(static_cast<std::uint32_t>(t));
                      if (first) continue;
                      const double e = std::sqrt(length_sq) - 1;
                      const double tension = threads_[t].stiffness * e + tangent(at, e).stress;
                      at = find_extension(lock, threads_[t].stiffness, tension, std::max(e, at));
                    }
                  });
}

void StretchLimit::add_linearisation_difference(std::span<const Vec3> x, const LockLinearisation& linearisation,
                                                std::span<Vec3> force) const {
  const Lock lock(stretch_);
  for (const std::uint32_t t : linearisation.beyond_onset) {
    const Thread& thread = threads_[t];
    const Vec3 s = derivative(thread, thread.along, x);
    const double length = s.norm(), e = length - 1;
    const double difference = thread.area * (tangent(linearisation.extensions[t], e).stress - lock.stress(e));
    if (difference == 0) continue;
    for (std::size_t k = 0; k < thread.corners; ++k)
      force[thread.particles[k]] -= difference / length * thread.along[k] * s;
  }
}

// The second derivative of the shear is a positive square plus a negative one (see Shear::add_stiffness()). If `exact`,
// uses both; else only the positive one.
template <class Body>
void StretchLimit::lock(const Crossing& piece, const Vec3& s_u, const Vec3& s_v, bool exact, const Body& body) const {
  const Lock lock(shear_);
  const double sine = s_u.dot(s_v), sign = sine < 0 ? -1 : 1;
  const double stress = piece.area * lock.stress(std::abs(sine)),
               stiffness = piece.area * lock.stiffness(std::abs(sine));
  CornerForces gradient{}, corner_forces{};  // ∂|sine|/∂x_k, and `stress` times it
  for (std::size_t k = 0; k < piece.corners; ++k) {
    gradient[k] = sign * (piece.weft[k] * s_v + piece.warp[k] * s_u);
    corner_forces[k] = stress * gradient[k];
  }
  const auto second = [&](std::size_t a, std::size_t b) {
    if (exact) return sign * (piece.weft[a] * piece.warp[b] + piece.warp[a] * piece.weft[b]);
    return 0.5 * (piece.weft[a] + sign * piece.warp[a]) * (piece.weft[b] + sign * piece.warp[b]);
  };
  body(corner_forces, [&](std::size_t a, std::size_t b) -> Mat3 {
    return stiffness * gradient[a] * gradient[b].transpose() + stress * second(a, b) * Mat3::Identity();
  });
}

double StretchLimit::energy(std::span<const Vec3> x) const {
  double sum = 0;
  const Lock stretch(stretch_), shear(shear_);
  for (const Thread& thread : threads_)
    sum += thread.area * stretch.energy(derivative(thread, thread.along, x).norm() - 1);
  for (const Crossing& c : crossings_)
    sum += c.area * shear.energy(std::abs(derivative(c, c.weft, x).dot(derivative(c, c.warp, x))));
  return sum;
}

StretchLimit::Worst StretchLimit::worst(std::span<const Vec3> x) const {
  using Longest = std::pair<double, std::ptrdiff_t>;  // ‖s‖², −index: the first of several longest pieces counts
  const Longest none{1, 1},
      longest = parallel_max(threads_.size(), kGrainSize, none, [&](std::size_t begin, std::size_t end) {
        Longest longest_in_range = none;
        for (std::size_t t = begin; t < end; ++t)
          longest_in_range = std::max(longest_in_range, {derivative(threads_[t], threads_[t].along, x).squaredNorm(),
                                                         -static_cast<std::ptrdiff_t>(t)});
        return longest_in_range;
      });
  Worst worst;
  if (longest == none) return worst;
  const Thread& thread = threads_[static_cast<std::size_t>(-longest.second)];
  worst.extension = std::sqrt(longest.first) - 1;
  for (std::size_t k = 0; k < thread.corners; ++k)
    worst.place += x[thread.particles[k]] / static_cast<double>(thread.corners);
  return worst;
}

}  // namespace weft::forces
