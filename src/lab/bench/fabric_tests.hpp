// Textile laboratory tests of a simulated fabric: drape, bending and extension.
#pragma once

#include <filesystem>
#include <vector>

#include "film/scene/scene.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::bench {

/// Cusick's drape test (ISO 9073-9): a disc of 30 cm diameter, held between plates of 18 cm, hangs over their edge.
namespace cusick {

inline constexpr double kPlateRadius = 0.09, kSpecimenRadius = 0.15;  // radii [m]

struct Specimen {
  std::vector<Vec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::size_t> held;  ///< indices of the particles between the plates
};

/// A disc of concentric rings of triangles. Ring k has 6 k vertices; `free` rings lie outside the plates, and the last
/// held ring lies on the edge of the plates. Vertices of the free rings are displaced by up to 0.15 of the spacing (on
/// the border only along it), so that no direction is preferred. `seed` selects the displacements.
Specimen rings(int free, int seed);

/// A scene that contains only the specimen, which is written to `file` (OBJ) and read from there.
scene::Scene scene_of(const Specimen& specimen, const scene::Material& material, const std::filesystem::path& file);

/// One pin for each of these particles.
std::vector<scene::Pin> pins_at(const std::vector<Vec3>& x, const std::vector<std::size_t>& held);

struct Drape {
  double coefficient = 0;     ///< visible fraction of the overhanging area, seen from above [1]
  double strain = 0;          ///< in the last frame, larger of weft and warp [1]
  double kinetic_energy = 0;  ///< in the last frame [J]
  double cpu_s = 0;
};

/// Accuracy of the solver. It affects the drape, since bending friction holds cloth where it first comes to rest.
/// `exactly`: newton_tolerance is so small that a third of it changes the drape by at most 0.3 percentage points.
enum class Solved { exactly, with_default_tolerance };

/// Simulates the fall of the level specimen for 1.5 s, within which it comes to rest. Throws Error(simulation_failed).
Drape drape(scene::Scene scene, const std::vector<mesh::Triangle>& triangles, Solved solved = Solved::exactly);

}  // namespace cusick

/// The cantilever test (ASTM D1388, option A): a strip 25 mm wide is pushed over an edge until the line from the edge
/// to the tip of the strip is 41.5° below the horizontal.
struct Cantilever {
  double bending_length = 0;  ///< half of the overhang [m]
  double rigidity = 0;        ///< density · 9.81 m/s² · bending_length³ [N·m]
};
/// Simulates strips with different overhangs; each strip starts level and hangs for 8 s. Throws
/// Error(simulation_failed).
Cantilever cantilever(const scene::Material& material);

enum class Direction { weft, warp };
/// Extension [1] of a hanging strip of 50 × 200 mm with `load` [N/m] at its lower end. Throws Error(simulation_failed).
double extension(const scene::Material& material, Direction direction, double load);

}  // namespace weft::bench
