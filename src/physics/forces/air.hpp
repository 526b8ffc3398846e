// Air drag on cloth.
#pragma once

#include <array>
#include <vector>

#include "physics/forces/force.hpp"
#include "physics/forces/lanes.hpp"
#include "physics/forces/ranges.hpp"

namespace weft::forces {

struct AirParameters {
  double density = 1.2;      ///< of the air [kg/m³]
  Vec3 wind = Vec3::Zero();  ///< velocity of the air [m/s], if Evaluation::air_velocity is empty
  double drag = 1.0;         ///< coefficient of drag along the normal
};

/// Quadratic drag f = −½ ρ c A ‖v_n‖ v_n along the normal of each face (cell or triangle), divided equally among the
/// corners of the face. ρ is the density of the air, c the drag coefficient, A the area of the
/// face, and v_n the normal component of the mean velocity of its corners relative to the air.
///
/// The drag is implicit although it is not stiff. If the drag were evaluated once per step, at the
/// initial velocity (Etzmuß et al. 2001, "Time integration"), terminal velocities and folds in
/// steady wind would depend on the step size. The matrix contains the derivative of the drag with
/// respect to velocities, lumped on the diagonal. The lumped matrix is an upper bound of the full
/// derivative, and exact if the velocities of all corners of a face change by the same amount. It
/// omits the derivatives of normals and areas.
class Air final : public Force {
 public:
  Air(const mesh::Grid& grid, Index first, const AirParameters& parameters);
  Air(const mesh::Sheet& sheet, Index first, const AirParameters& parameters);

  void append_couplings(std::vector<std::pair<Index, Index>>& /*pairs*/) const override {}
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  double energy(std::span<const Vec3> /*x*/) const override { return 0; }

 private:
  /// Four cells or triangles; unused lanes have `is_used` = 0.
  template <std::size_t Corners>
  struct Faces {
    std::array<IndexLanes, Corners> corners{};
    Lanes is_used{};
  };
  template <std::size_t Corners>
  static std::vector<Faces<Corners>> pack(const std::vector<std::array<Index, Corners>>& faces);
  template <std::size_t Corners>
  void add_drag(const Faces<Corners>& faces, const Evaluation& at) const;

  Vec3 wind_;
  double coefficient_;           // ½ ρ c [kg/m³]
  std::vector<Faces<4>> cells_;  // corners in the order (0,0), (1,0), (1,1), (0,1)
  std::vector<Faces<3>> triangles_;
  Ranges ranges_of_cells_, ranges_of_triangles_;
};

}  // namespace weft::forces
