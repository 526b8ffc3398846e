// Bending of cloth made of triangles, with flat or curved rest shapes.
#pragma once

#include "physics/forces/bend_damping.hpp"
#include "physics/forces/force.hpp"
#include "physics/forces/triangle_curvature.hpp"

namespace weft::forces {

/// The plate model of class Bend (for grids), for triangles: energy ½ B A Σ_ab ‖s_ab − κ_ab n‖², where ab is uu, vv, uv
/// and vu. B is the rigidity, A the area, s_ab the curvature vectors of CurvatureStencil, n the triangle's unit normal,
/// and κ_ab the signed rest curvature, positive if the sheet bends toward its front. If the rest shape is curved, its
/// s_ab also have in-plane components. The stencil subtracts these components as multiples of the
/// triangle's tangents s_u and s_v. Thus the subtracted vectors turn with the triangle, and the
/// rest shape has no energy.
///
/// The part of the energy without κ_ab is quadratic, and its Hessian is constant and positive
/// semidefinite, as for grids. The part −B A Σ_ab κ_ab n·s_ab of triangles with rest curvature is
/// not quadratic; every evaluation computes its forces and its matrix anew. For viscosity and
/// friction see BendDamping.
class TriangleBend final : public Force {
 public:
  /// `pinned`: per particle, in the global numbering, whether set_held() may hold it. These
  /// particles are held until the first call of set_held(). Empty: no particle.
  TriangleBend(const mesh::Sheet& sheet, Index first, const BendParameters& parameters,
               std::span<const char> pinned = {});

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  bool isotropic() const override;
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;
  void add_constant_stiffness(solver::Assembly& assembly) const override;
  void set_held(std::span<const char> held) override;

 private:
  struct Element {
    std::size_t begin, end;    // range of its particles in particles_ and weights_, corners first
    std::size_t pairs;         // index of its first pair, in scalars_ and blocks_; order 01, 02, ... 12, ...
    double area;               // [m²], times Reinforcement::bend
    Vec3 rest = Vec3::Zero();  // κ_uu, κ_vv, κ_uv [1/m]
  };
  using PaddedVec3 = solver::PaddedVec3<double>;
  /// s_uu, s_vv and s_uv [1/m] of one element, and of four elements.
  using Curvature = std::array<PaddedVec3, 3>;
  using CurvatureLanes = std::array<VecLanes, 3>;
  std::span<const Index> particles(const Element& e) const {
    return std::span(particles_).subspan(e.begin, e.end - e.begin);
  }
  Curvature curvature(const Element& element, std::span<const PaddedVec3> x) const;
  Mat3 curvature(const Element& element, std::span<const Vec3> x) const;  // s_uu, s_vv and s_uv as columns
  CurvatureLanes curvatures(std::size_t first, std::size_t count, std::span<const PaddedVec3> x) const;
  void rebuild_elements();
  void add_pairs(const Element& element, const Vec3& stiffness, std::vector<double>& scratch,
                 const solver::AssemblyRows& assembly) const;
  template <class Push, class AddBlock>
  void rest_moment(const Element& element, const Mat3& curved, const std::array<Vec3, 3>& corners, bool exact,
                   const Push& push, const AddBlock& add_block) const;
  void add_rest_moment(const Element& element, const Curvature& curved, const Evaluation& at) const;

  Index first_;
  double rigidity_;
  BendDamping damping_;
  mesh::Sheet sheet_;                // for the stencils, if any triangle has three pinned corners; else empty
  std::vector<char> pinned_, held_;  // per vertex of the sheet; empty: none
  std::vector<Element> elements_;
  // Concatenated over all elements.
  std::vector<Index> particles_;
  std::vector<PaddedVec3> weights_;  // of s_uu, s_vv and s_uv [1/m²]
  std::vector<Index> scalars_;       // per pair: Assembly::scalar()
  std::vector<Index> blocks_;        // per pair: Assembly::block(), if any element is curved at rest; else empty
  Ranges ranges_;                    // of packs of four elements
};

}  // namespace weft::forces
