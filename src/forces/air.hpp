// Air resistance of cloth.
#pragma once

#include <array>
#include <vector>

#include "forces/force.hpp"
#include "forces/lanes.hpp"
#include "forces/ranges.hpp"

namespace weft::forces {

struct AirParameters {
  double density = 1.2;      ///< of the air [kg/m³]
  Vec3 wind = Vec3::Zero();  ///< velocity of the air [m/s], unless an evaluation brings its own
  double drag = 1.0;         ///< coefficient of the motion along the normal
};

/// Quadratic drag of the motion along the normal of each cell or triangle: f = −½ ρ c A ‖v_n‖ v_n, shared by its
/// corners.
///
/// Inside of the implicit stage, though it is not stiff: taken once a step outside of it (seed, "Time integration"), at
/// the velocity of the start, it made terminal velocities and the folds of cloth in steady wind depend on the step.
/// The matrix gets what the velocities change, summed up on the diagonal: no less than the whole, and exact where the
/// corners of a face change their velocity together. That normals and areas turn with the cloth is left out.
class Air final : public Force {
 public:
  Air(const mesh::Grid& grid, Index first, const AirParameters& parameters);
  Air(const mesh::Sheet& sheet, Index first, const AirParameters& parameters);

  void couple(std::vector<std::pair<Index, Index>>& /*pairs*/) const override {}
  void attach(const solver::Assembly& /*assembly*/) override {}
  void cut(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  double energy(std::span<const Vec3> /*x*/) const override { return 0; }

 private:
  /// Four cells or triangles; those that do not count are none.
  template <std::size_t Corners>
  struct Faces {
    std::array<Four, Corners> corners{};
    Lanes counts{};
  };
  template <std::size_t Corners>
  static std::vector<Faces<Corners>> pack(const std::vector<std::array<Index, Corners>>& faces);
  template <std::size_t Corners>
  void push(const Faces<Corners>& faces, const Evaluation& at) const;

  Vec3 wind_;
  double coefficient_;           // ½ ρ c [kg/m³]
  std::vector<Faces<4>> cells_;  // corners in the order (0,0), (1,0), (1,1), (0,1)
  std::vector<Faces<3>> triangles_;
  Ranges ranges_of_cells_, ranges_of_triangles_;
};

}  // namespace weft::forces
