// Bending of cloth made of triangles, about flat rest shapes and others.
#pragma once

#include "forces/bend_damping.hpp"
#include "forces/force.hpp"
#include "forces/triangle_curvature.hpp"

namespace weft::forces {

/// The plate of Bend on triangles: energy ½ B A Σ_ab ‖s_ab − κ_ab n‖², summed over uu, vv and twice uv, with the
/// curvature vectors of CurvatureStencil, the triangle's unit normal n and the signed curvature κ_ab of the rest shape:
/// positive where the sheet bends toward the front. Where the rest shape is curved, what its s_ab has in the plane is
/// taken out along s_u and s_v, so that the rest shape itself has no energy.
///
/// The part without κ is quadratic with a constant, definite Jacobian, as for quads; only triangles with rest curvature
/// add to it in every evaluation, −B A κ_ab n·s_ab. Viscosity and friction: see BendDamping.
class TriangleBend final : public Force {
 public:
  /// `pinned`: of all particles, those that hold() may be given; they are held at first. Empty: none.
  TriangleBend(const mesh::Sheet& sheet, Index first, const BendParameters& parameters,
               std::span<const char> pinned = {});

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  bool isotropic() const override;
  void attach(const solver::Assembly& assembly) override;
  void cut(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;
  void add_constant_stiffness(solver::Assembly& assembly) const override;
  void hold(std::span<const char> held) override;

 private:
  using Quad = solver::Quad<double>;
  struct Element {
    std::size_t begin, end;    // of its particles, corners first
    std::size_t pairs;         // the first of them, 01, 02, ... 12, ...
    double area;               // [m²], times the reinforcement
    Vec3 rest = Vec3::Zero();  // κ_uu, κ_vv, κ_uv [1/m]
  };
  /// s_uu, s_vv and s_uv of an element, of four elements.
  using Curvature = std::array<Quad, 3>;
  using CurvatureLanes = std::array<VecLanes, 3>;
  std::span<const Index> particles(const Element& e) const {
    return std::span(particles_).subspan(e.begin, e.end - e.begin);
  }
  Curvature curvature(const Element& element, std::span<const Quad> x) const;
  Mat3 curvature(const Element& element, std::span<const Vec3> x) const;  // as columns
  CurvatureLanes curvatures(std::size_t first, std::size_t count, std::span<const Quad> x) const;
  void use_held();
  void add_pairs(const Element& element, const Vec3& stiffness, std::vector<double>& scratch,
                 const solver::AssemblyRows& assembly) const;
  template <class Push, class AddBlock>
  void rest_moment(const Element& element, const Mat3& curved, const std::array<Vec3, 3>& corners, bool exact,
                   const Push& push, const AddBlock& add_block) const;
  void add_rest_moment(const Element& element, const Curvature& curved, const Evaluation& at) const;

  Index first_;
  double rigidity_;
  BendDamping damping_;
  mesh::Sheet sheet_;                // where pins let go: what stencils are made of; else empty
  std::vector<char> pinned_, held_;  // per vertex of the sheet
  std::vector<Element> elements_;
  // One after the other, of all elements.
  std::vector<Index> particles_;
  std::vector<Quad> weights_;   // of s_uu, s_vv and s_uv [1/m²]
  std::vector<Index> scalars_;  // of pairs
  std::vector<Index> blocks_;   // likewise, where an element is curved at rest; else empty
  Ranges ranges_;               // of four elements
};

}  // namespace weft::forces
