#include "physics/forces/rigidity.hpp"

namespace weft::forces {
namespace {

constexpr std::size_t kParticles = mesh::RigidFrame::kParticles;
constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

}  // namespace

Rigidity::Rigidity(const mesh::RigidFrame& frame, Index first, double mass, double stiffness)
    : first_(first), deviations_(frame.deviations()), modulus_(stiffness * mass) {}

void Rigidity::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const auto& [i, j] : kPairs) pairs.emplace_back(first_ + static_cast<Index>(i), first_ + static_cast<Index>(j));
}

void Rigidity::attach(const solver::Assembly& assembly) {
  for (std::size_t p = 0; p < kPairs.size(); ++p)
    blocks_[p] = assembly.block(first_ + static_cast<Index>(kPairs[p][0]), first_ + static_cast<Index>(kPairs[p][1]));
}

// B from the positions of the particles.
template <class Position>
Mat3 Rigidity::shape_of(const Position& position) const {
  Mat3 shape = Mat3::Zero();
  for (std::size_t k = 0; k < kParticles; ++k)
    shape += 0.25 * position(static_cast<std::size_t>(first_) + k) * mesh::RigidFrame::corner(k).transpose();
  return shape;
}

// W Bᵀ B W − W⁻² [m]
Mat3 Rigidity::strain_of(const Mat3& shape) const {
  const Mat3 scaled = shape * deviations_.cwiseSqrt().cwiseInverse().asDiagonal();
  return scaled.transpose() * scaled - Mat3(deviations_.asDiagonal());
}

void Rigidity::add(const Evaluation& at) const {
  const auto stage = [&](std::size_t i) { return solver::vec3_of(at.x[i]); };
  const Mat3 shape = shape_of(stage);
  // With the midpoint rule, for which `past` is empty, the step ends half a step (1 / rate) after
  // the stage. With the other methods, it ends at the stage.
  const double time_to_end = at.past.empty() && at.rate > 0 ? 1 / at.rate : 0;
  const Mat3 strain =
      strain_of(shape_of([&](std::size_t i) { return Vec3(stage(i) + time_to_end * solver::vec3_of(at.v[i])); }));
  const Vec3 root = deviations_.cwiseSqrt().cwiseInverse();
  const Mat3 stress = 0.5 * modulus_ * shape * root.asDiagonal() * strain * root.asDiagonal();
  for (std::size_t k = 0; k < kParticles; ++k)
    at.force.add(first_ + static_cast<Index>(k),
                 solver::padded<double>(Vec3(-0.25 * stress * mesh::RigidFrame::corner(k))));
  if (!at.assembly) return;
  // The matrix omits the geometric stiffness (that of the stress), which is small but may be
  // indefinite.
  const Mat3 affine_map = shape * deviations_.cwiseInverse().asDiagonal();  // A
  const Mat3 affine_shape = affine_map * shape.transpose();
  const double end_rate = time_to_end > 0 ? 2 : 1;
  for (std::size_t p = 0; p < kPairs.size(); ++p) {
    const Vec3 t = mesh::RigidFrame::corner(kPairs[p][0]), u = mesh::RigidFrame::corner(kPairs[p][1]);
    const Mat3 block =
        t.dot(u.cwiseQuotient(deviations_)) * affine_shape + (affine_map * u) * (affine_map * t).transpose();
    at.assembly.add(blocks_[p], Mat3(end_rate * modulus_ / 32 * block));
  }
}

double Rigidity::energy(std::span<const Vec3> x) const {
  return 0.125 * modulus_ * strain_of(shape_of([&](std::size_t i) { return x[i]; })).squaredNorm();
}

}  // namespace weft::forces
