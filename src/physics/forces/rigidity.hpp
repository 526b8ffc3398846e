// Elastic force that keeps a rigid body in shape.
#pragma once

#include <array>

#include "core/types.hpp"
#include "physics/forces/force.hpp"
#include "physics/mesh/rigid_frame.hpp"

namespace weft::forces {

/// Keeps the distances between the four particles p_k of a rigid body (mesh::RigidFrame, with deviations s and corners
/// t_k). If the body is not deformed, B = ¼ Σ p_k t_kᵀ equals R diag(s) with a rotation R. With the body's mass m, the
/// stiffness κ and W = diag(s)^-½, the energy is κ m/8 ‖W Bᵀ B W − W⁻²‖². It equals
/// κ m/8 ‖W⁻¹ (AᵀA − I) W⁻¹‖², an energy of the strain AᵀA − I of an affine body, A = B diag(s)⁻¹ (Lan et al., "Affine
/// Body Dynamics", 2022). Because of the weights W⁻¹, stretch along each axis has the same angular
/// frequency √κ, so that thin bodies are as rigid as round ones.
///
/// The force is proportional to the strain at the end of the step, times the derivatives of the
/// strain at the stage positions (integrator::StagePoint). With the midpoint rule, the stage is
/// half-way along the straight trajectories of the particles: there a body that only rotates is
/// shrunk, but at the end of the step it has no strain, so the force does not resist rotation. As
/// the force depends on the end of the step, every method damps the strain.
class Rigidity final : public Force {
 public:
  /// `first`: the body's first particle; `mass`: of the body [kg]; `stiffness`: κ [1/s²].
  Rigidity(const mesh::RigidFrame& frame, Index first, double mass, double stiffness);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void add(const Evaluation& at) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  template <class Position>
  Mat3 shape_of(const Position& position) const;
  Mat3 strain_of(const Mat3& shape) const;

  Index first_;
  Vec3 deviations_;  // s [m]
  double modulus_;   // κ m [N/m]
  std::array<Index, 6> blocks_{};
};

}  // namespace weft::forces
