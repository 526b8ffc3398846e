// Air resistance: non-stiff, evaluated once a step outside of the implicit solve (seed, "Time integration").
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "mesh/mesh.hpp"
#include "mesh/sheet.hpp"

namespace weft::forces {

struct AirParameters {
  double density = 1.2;      ///< of the air [kg/m³]
  Vec3 wind = Vec3::Zero();  ///< velocity of the air [m/s]
  double drag = 1.0;         ///< coefficient of the motion along the normal
};

/// Quadratic drag of the motion along the normal of each cell or triangle: f = −½ ρ c A ‖v_n‖ v_n, shared by its
/// corners.
class Air {
 public:
  Air(const mesh::Grid& grid, Index first, const AirParameters& parameters);
  /// `cloth_density` [kg/m²].
  Air(const mesh::Sheet& sheet, Index first, double cloth_density, const AirParameters& parameters);

  /// What the state stands for at which drag is taken.
  enum class Taken { over_the_step, at_that_moment };

  /// force += the drag of a step over h at (x, v) [N]. Over the step from v on, drag alone would take an inner particle
  /// of mass m to v / (1 + z), z = h c ‖v‖ / m, the exact solution of m v' = −c ‖v‖ v; the force returned gives just
  /// that. Taken at the moment of v it is the law itself but for z² / 2, by which it is divided by √(1 + z²): a mean
  /// over the step would be off by z, and cost methods of second order an order. Neither turns a motion round, however
  /// long the step and light the cloth.
  void add(std::span<const Vec3> x, std::span<const Vec3> v, std::span<const double> masses, double h, Taken taken,
           std::span<Vec3> force) const;

 private:
  AirParameters parameters_;
  std::vector<std::array<Index, 4>> cells_;  // corners in the order (0,0), (1,0), (1,1), (0,1)
  struct Triangle {
    mesh::Triangle corners;
    double mass;  // [kg]
  };
  std::vector<Triangle> triangles_;
};

}  // namespace weft::forces
