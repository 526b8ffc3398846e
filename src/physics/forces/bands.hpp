// Elastic bands, hems, and seam allowances along edges of cloth.
#pragma once

#include <array>

#include "physics/forces/force.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::forces {

/// The bands of a sheet. A piece of an elastic band, with length l, rest length r and stiffness k [N], has the energy
/// ½ k r (l/r − 1)². At each particle between two pieces, a hem has the energy ½ E L ‖s''‖² with the bending stiffness
/// E [N·m²], the second difference s'' of the positions, and the mean L of the rest lengths of the cloth along both
/// pieces. A hem is straight at rest. Therefore, if the edge of the cloth is curved with a radius R
/// at rest, the hem acts on the cloth with a force of about E/R² [N]. A seam allowance is an
/// elastic band as stiff as a strip of cloth of its width.
class Bands final : public Force {
 public:
  /// `stretch`: stretch stiffness of the cloth, for seam allowances [N/m].
  Bands(const mesh::Sheet& sheet, Index first, double stretch);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;
  void add_constant_stiffness(solver::Assembly& assembly) const override;

  /// For sewn sheets: interpolates the rest length of each piece between its length at the start
  /// positions (`progress` 0) and its rest length in the sewing pattern, Band::ratio times that of
  /// the cloth (`progress` 1).
  void interpolate_rest_shape(double progress);

 private:
  struct Piece {
    std::array<Index, 2> particles;
    double stiffness;            // [N]
    double start, pattern_rest;  // rest lengths at progress 0 and 1 of sewing [m]
    double rest;                 // r, current rest length [m]
    Index block = 0;
  };
  struct Bend {
    std::array<Index, 3> particles;
    Vec3 weights;                    // of s'' [1/m²]
    double stiffness;                // E L [N·m³]
    std::array<Index, 3> scalars{};  // of the pairs 01, 12, 20
  };
  static Mat3 stiffness(const Piece& piece, const Vec3& along, double lateral);

  std::vector<Piece> pieces_;
  std::vector<Bend> bends_;
};

}  // namespace weft::forces
