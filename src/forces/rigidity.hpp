// What keeps a rigid body in shape.
#pragma once

#include <array>

#include "core/types.hpp"
#include "forces/force.hpp"
#include "mesh/rigid_frame.hpp"

namespace weft::forces {

/// The four particles p_k of a rigid body (mesh::RigidFrame) keep their distances. With B = ¼ Σ p_k t_kᵀ, which is
/// R diag(s) in a body that is rigid, the energy is κ m / 8 ‖W Bᵀ B W − W⁻²‖², W = diag(s)^-½: that of the strain AᵀA −
/// I of an affine body (Lan et al., "Affine Body Dynamics", 2022) in measures in which all stretches have the same
/// frequency √κ, so that thin bodies are as rigid as round ones.
///
/// The strain is that of the end of a step, and acts along the directions of its stage. So a body turns without
/// resisting with the midpoint rule, and its strain is damped with each method.
class Rigidity final : public Force {
 public:
  /// `first`: of its particles; `mass`: of the body [kg]; `stiffness`: κ [1/s²].
  Rigidity(const mesh::RigidFrame& frame, Index first, double mass, double stiffness);

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void cut(std::span<const Index> /*bounds*/) override {}  // small
  void add(const Evaluation& at) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  template <class Position>
  Mat3 shape_of(const Position& position) const;
  Mat3 strain_of(const Mat3& shape) const;

  Index first_;
  Vec3 deviations_;
  double modulus_;  // κ m [N/m]
  std::array<Index, 6> blocks_{};
};

}  // namespace weft::forces
