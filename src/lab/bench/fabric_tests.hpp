// Textile laboratory tests of a simulated fabric: drape, bending and extension.
#pragma once

#include <filesystem>
#include <vector>

#include "film/scene/scene.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::bench {

/// Cusick's drape test (ISO 9073-9): two round plates (diameter 18 cm) hold the middle of a disc of fabric (30 cm). The
/// rim of the disc hangs down.
namespace cusick {

inline constexpr double kPlateRadius = 0.09, kSpecimenRadius = 0.15;  // radii [m]

struct Specimen {
  std::vector<Vec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::size_t> held;  ///< indices of the particles between the plates
};

/// A disc of concentric rings of vertices; ring k has 6 k vertices. `free` rings lie outside of the plates; the
/// outermost held ring lies on the edge of the plates. Vertices of the free rings are displaced by up to 0.15 of the
/// spacing, so that no direction is preferred; vertices on the border of the disc move only along this border. `seed`
/// selects the displacements.
Specimen rings(int free, int seed);

/// A scene with the specimen alone. Writes the specimen to `file` (OBJ), from which the scene reads it.
scene::Scene scene_of(const Specimen& specimen, const scene::Material& material, const std::filesystem::path& file);

/// One pin for each of the particles `held` (indices). `x`: positions of all particles in the flat
/// cloth [m].
std::vector<scene::Pin> pins_at(const std::vector<Vec3>& x, const std::vector<std::size_t>& held);

/// Result of the drape test.
struct Drape {
  double coefficient = 0;     ///< area of the overhang as seen from above / area of the flat overhang
  double strain = 0;          ///< largest |strain| along weft or warp in any step of the last frame
  double kinetic_energy = 0;  ///< in the last frame [J]
  double cpu_s = 0;
};

/// Accuracy of the solver. It affects the drape, because bending friction holds cloth in the shape in which the cloth
/// first comes to rest. `exactly`: newton_tolerance is 0.01. (Measured: a third of 0.01 changes the drape coefficient
/// by at most 0.003.) `with_default_tolerance`: newton_tolerance is that of `scene`.
enum class Solved { exactly, with_default_tolerance };

/// Simulates the specimen for 1.5 s: from level, it falls and comes to rest. Throws Error(simulation_failed).
Drape drape(scene::Scene scene, const std::vector<mesh::Triangle>& triangles, Solved solved = Solved::exactly);

}  // namespace cusick

/// Result of the cantilever test (ASTM D1388, option A): a strip 25 mm wide is pushed over an edge until the line from
/// the edge to the tip of the strip is 41.5° below the horizontal.
struct Cantilever {
  double bending_length = 0;  ///< half of the overhang [m]
  double rigidity = 0;        ///< density · 9.81 m/s² · bending_length³ [N·m]
};
/// Finds the overhang by simulating strips of different overhangs. Each strip is level at first and
/// is simulated for 8 s. Throws Error(simulation_failed).
Cantilever cantilever(const scene::Material& material);

enum class Direction { weft, warp };
/// Relative extension of a hanging strip of 50 × 200 mm with `load` [N/m] at its end. Throws Error(simulation_failed).
double extension(const scene::Material& material, Direction direction, double load);

}  // namespace weft::bench
