// Tests of the textile laboratory, done with a fabric of ours: how it drapes, bends and stretches.
#pragma once

#include <filesystem>
#include <vector>

#include "mesh/topology.hpp"
#include "scene/scene.hpp"

namespace weft::bench {

/// Cusick's drape test (ISO 9073-9): a disc of 30 cm, held between plates of 18 cm, hangs over their edge.
namespace cusick {

inline constexpr double kPlates = 0.09, kSpecimen = 0.15;  // radii [m]

struct Specimen {
  std::vector<Vec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::size_t> held;  ///< particles between the plates
};

/// Rings of triangles, the k-th with 6 k vertices, `free` of them outside of the plates. Where that of the others is
/// regular their place is off by up to 0.15 of the spacing, so that no direction is better than another; `seed` says
/// how. The last held ring is the plates' edge.
Specimen rings(int free, int seed);

/// The specimen as a cloth of a scene without anything else. It is written to `file`, an OBJ, and read from there.
scene::Scene scene_of(const Specimen& specimen, const scene::Material& material, const std::filesystem::path& file);

/// Pins that hold these particles, each its own.
std::vector<scene::Pin> pins_at(const std::vector<Vec3>& x, const std::vector<std::size_t>& held);

struct Drape {
  double coefficient = 0;     ///< share of what overhangs that is seen from above [1]
  double strain = 0;          ///< largest of weft and warp [1]
  double kinetic_energy = 0;  ///< at the end [J]
  double cpu_s = 0;
};

/// Friction of bending holds cloth where it first comes to rest, so that what a step leaves decides too: `exactly`,
/// with a tenth of which it drapes as before, or as scenes do that say nothing.
enum class Solved { exactly, as_scenes_do };

/// Lets the specimen fall from level for 1.5 s, and comes to rest in that. Throws Error(simulation_failed).
Drape drape(scene::Scene scene, const std::vector<mesh::Triangle>& triangles, Solved solved = Solved::exactly);

}  // namespace cusick

/// The cantilever test (ASTM D1388, option A): a strip of 25 mm is pushed over an edge until its tip is seen from there
/// 41.5° below level.
struct Cantilever {
  double bending_length = 0;  ///< half of the overhang [m]
  double rigidity = 0;        ///< density · 9.81 m/s² · bending_length³ [N·m]
};
/// Each overhang that is tried falls from level, and is read after 8 s. Throws Error(simulation_failed).
Cantilever cantilever(const scene::Material& material);

enum class Direction { weft, warp };
/// Extension of a strip of 50 × 200 mm that hangs, with `load` [N/m] at its lower end [1]. Throws
/// Error(simulation_failed).
double extension(const scene::Material& material, Direction direction, double load);

}  // namespace weft::bench
