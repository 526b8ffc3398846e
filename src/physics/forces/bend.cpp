#include "physics/forces/bend.hpp"

namespace weft::forces {
namespace {

// Inlined, because a call would return the twelve numbers of the result through memory.
template <class Differences, class Points>
[[gnu::always_inline]] inline VecLanes weighted_sum(const Differences& d, Points x) {
  VecLanes sum = d.weights[0] * gather(x, d.particles[0]);
  for (std::size_t k = 1; k < d.particles.size(); ++k) sum = sum + d.weights[k] * gather(x, d.particles[k]);
  return sum;
}

// Adds size × weights[a] × weights[b] to the Assembly's scalar of each pair of particles a < b.
template <class Differences>
void add_pairs(const Differences& d, const Lanes& size, const solver::AssemblyRows& assembly) {
  for (std::size_t a = 0, pair = 0; a < d.particles.size(); ++a) {
    const Lanes row = size * d.weights[a];
    for (std::size_t b = a + 1; b < d.particles.size(); ++b, ++pair)
      add_scalars(assembly, d.scalars[pair], row * d.weights[b]);
  }
}

}  // namespace

Bend::Bend(const mesh::Grid& grid, Index first, const BendParameters& parameters)
    : grid_(grid), first_(first), rigidity_(parameters.rigidity), damping_(parameters) {
  Bend::set_held({});
  lines_.packs.shrink_to_fit();
  cells_.packs.shrink_to_fit();
}

// Creates all differences. Only their weights and areas depend on `held`; their particles and order
// do not, so the sparsity pattern of the Jacobian does not change.
void Bend::set_held(std::span<const char> held) {
  lines_.size = cells_.size = 0;
  const mesh::Grid& grid = grid_;
  const auto at = [&](int i, int j) { return first_ + grid.index(i, j); };
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      const bool last_i = i + 1 == grid.nu, last_j = j + 1 == grid.nv;
      if (i > 0 && !last_i)
        add_line({at(i - 1, j), at(i, j), at(i + 1, j)}, grid.du(i - 1), grid.du(i), grid.width_v(j), held);
      if (j > 0 && !last_j)
        add_line({at(i, j - 1), at(i, j), at(i, j + 1)}, grid.dv(j - 1), grid.dv(j), grid.width_u(i), held);
      // The energy contains 2 ‖s_uv‖², so the area counts twice.
      if (last_i || last_j) continue;
      const double cell = grid.du(i) * grid.dv(j), uv = 1 / cell;
      cells_.add({at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)}, {uv, -uv, -uv, uv}, 2 * cell);
    }
  }
}

template <std::size_t Count>
void Bend::List<Count>::add(const std::array<Index, Count>& particles, const std::array<double, Count>& weights,
                            double area) {
  const std::size_t lane = size++ % 4;
  if (packs.size() < packs_of(size)) packs.emplace_back();
  Differences<Count>& pack = packs[packs_of(size) - 1];
  // Fills the following lanes, too: until a later call overwrites them, they repeat this difference with area 0.
  for (std::size_t l = lane; l < 4; ++l) {
    for (std::size_t k = 0; k < Count; ++k) pack.particles[k][l] = particles[k], pack.weights[k][l] = weights[k];
    pack.area[l] = l == lane ? area : 0;
  }
}

// Adds the second difference at the middle one of three particles: the change of slope, divided by
// the length over which the slope changes. This length is the mean of both spacings, or at a clamp
// half of the spacing on the free side (see Bend). Except at clamps, the second difference is exact
// for parabolas. The weights sum to zero, so that a translation causes no curvature.
void Bend::add_line(const std::array<Index, 3>& particles, double before, double after, double width,
                    std::span<const char> held) {
  const auto is_held = [&](std::size_t k) { return !held.empty() && held[particles[k]]; };
  double length = 0.5 * (before + after);
  if (is_held(1) && is_held(0) != is_held(2)) length = 0.5 * (is_held(0) ? after : before);
  const double first = 1 / (before * length), last = 1 / (after * length);
  lines_.add(particles, {first, -(first + last), last}, length * width);
}

template <class Body>
void Bend::for_all(const Body& body) const {
  for (const auto& lines : lines_.packs) body(lines);
  for (const auto& cells : cells_.packs) body(cells);
}

void Bend::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for_all([&](const auto& d) {
    for (std::size_t a = 0; a < d.particles.size(); ++a)
      for (std::size_t b = a + 1; b < d.particles.size(); ++b)
        for (std::size_t l = 0; l < 4; ++l) pairs.emplace_back(d.particles[a][l], d.particles[b][l]);
  });
}

void Bend::attach(const solver::Assembly& assembly) {
  const auto scalar = [&](Index i, Index j) { return assembly.scalar(i, j); };
  for (auto& lines : lines_.packs) find_pairs(lines.particles, lines.scalars, scalar);
  for (auto& cells : cells_.packs) find_pairs(cells.particles, cells.scalars, scalar);
}

void Bend::partition(std::span<const Index> bounds) {
  cut_packs(
      bounds, lines_.packs, [](const auto& d) { return std::span(d.particles); }, lines_.ranges);
  cut_packs(
      bounds, cells_.packs, [](const auto& d) { return std::span(d.particles); }, cells_.ranges);
}

void Bend::add(const Evaluation& at) const {
  lines_.ranges.for_each(at.range, lines_.packs.size(), [&](std::size_t p) { add(lines_.packs[p], at); });
  cells_.ranges.for_each(at.range, cells_.packs.size(), [&](std::size_t p) { add(cells_.packs[p], at); });
}

// The stiffness of damping is proportional to c cᵀ, with c as in BendDamping. The matrix contains
// ‖c‖² I instead, so that all of bending needs scalars only, no 3×3 blocks. Both have the same
// effect along c, which is nearly parallel to the surface normal. Across c, ‖c‖² I is too stiff,
// but the stretch stiffness is usually far greater.
template <std::size_t Count>
void Bend::add(const Differences<Count>& d, const Evaluation& at) const {
  const VecLanes curvature = weighted_sum(d, at.x);
  VecLanes moment = lanes_of(rigidity_) * curvature;
  if (damping_.is_active()) {
    const VecLanes velocity = weighted_sum(d, at.v);
    const VecLanes c = at.rate > 0 ? curvature - lanes_of(1 / at.rate) * velocity : curvature;
    const Lanes c_sq = dot(c, c), rate = dot(c, velocity), secant = damping_.secant(c_sq, rate);
    moment = moment + secant * rate * c;
    if (at.assembly) add_pairs(d, at.rate * d.area * secant * c_sq, at.assembly);
  }
  moment = d.area * moment;
  for (std::size_t k = 0; k < Count; ++k) subtract(at.force, d.particles[k], d.weights[k] * moment);
}

void Bend::add_constant_stiffness(solver::Assembly& assembly) const {
  for_all([&](const auto& d) { add_pairs(d, rigidity_ * d.area, assembly); });
}

void Bend::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                        solver::BlockMatrix& jacobian) const {
  for_all([&](const auto& d) {
    const VecLanes of_x = weighted_sum(d, x), of_v = weighted_sum(d, v);
    for (std::size_t l = 0; l < 4; ++l) {
      const Mat3 damping =
          damping_.stiffness({of_x.x[l], of_x.y[l], of_x.z[l]}, {of_v.x[l], of_v.y[l], of_v.z[l]}, rate);
      const Mat3 stiffness = d.area[l] * (rigidity_ * Mat3::Identity() + damping);
      for (std::size_t a = 0; a < d.particles.size(); ++a)
        for (std::size_t b = 0; b < d.particles.size(); ++b)
          jacobian.add(jacobian.slot(d.particles[a][l], d.particles[b][l]), d.weights[a][l] * d.weights[b][l],
                       stiffness);
    }
  });
}

double Bend::energy(std::span<const Vec3> x) const {
  Lanes sum{};
  for_all([&](const auto& d) {
    const VecLanes curvature = weighted_sum(d, x);
    sum += 0.5 * rigidity_ * d.area * dot(curvature, curvature);
  });
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace weft::forces
