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

  /// force += the drag at (x, v) [N]. Over a step h drag alone would take an inner particle of mass m from v to
  /// v / (1 + h c ‖v‖ / m), the exact solution of m v' = −c ‖v‖ v; the force returned gives just that, so it never
  /// turns a motion round, however long the step and light the cloth.
  void add(std::span<const Vec3> x, std::span<const Vec3> v, std::span<const double> masses, double h,
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
