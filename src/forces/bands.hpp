// Elastic bands and hems along edges of cloth.
#pragma once

#include <array>

#include "forces/force.hpp"
#include "mesh/sheet.hpp"

namespace weft::forces {

/// The bands of a sheet. A piece of length l, rest length r, between two particles of an elastic band of stiffness k
/// [N] has the energy ½ k r (l / r − 1)². A hem has the bending energy ½ E l ‖s''‖² at each particle between two
/// pieces, with s'' the change of the unit tangent at rest by length, and is straight at rest: a hem that is curved in
/// its panel with a radius R is pulled by E / R² [N], which is nothing beside the cloth's own stiffness.
/// The allowance of a seam is an elastic band as stiff as a strip of the cloth of that width.
class Bands final : public Force {
 public:
  /// `stretch` [N/m]: stiffness of the cloth.
  Bands(const mesh::Sheet& sheet, Index first, double stretch);

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void cut(std::span<const Index> /*bounds*/) override {}  // few
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;
  void add_constant_stiffness(solver::Assembly& assembly) const override;

  /// Of a sewn sheet: rest lengths of elastic bands between those of the start, at share 0, and their own, at 1.
  void rest_between_start_and_pattern(double share);

 private:
  struct Piece {
    std::array<Index, 2> particles;
    double stiffness;   // [N]
    double start, own;  // rest lengths [m]
    double rest;        // the one now [m]
    Index block = 0;
  };
  struct Bend {
    std::array<Index, 3> particles;
    Vec3 weights;                    // of s'' [1/m²]
    double stiffness;                // E l [N·m³]
    std::array<Index, 3> scalars{};  // of the pairs 01, 12, 20
  };
  static Mat3 stiffness(const Piece& piece, const Vec3& along, double lateral);

  std::vector<Piece> pieces_;
  std::vector<Bend> bends_;
};

}  // namespace weft::forces
