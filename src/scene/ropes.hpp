// Conversion of ropes for the rest of the program: material figures, start shape, and the cloth that represents a rope.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

/// Figures of a kind of rope; mass and stretch are divided by the square of the nominal diameter [m].
struct RopeMaterial {
  std::string name;
  double mass;            ///< [kg/m per m²]
  double stretch;         ///< force per strain [N per m²]
  double bending_length;  ///< cube root of (bending stiffness / weight per length), in diameters
};
const std::vector<RopeMaterial>& rope_materials();

/// Figures of one rope; those that the scene does not give are derived from its material.
struct RopeNumbers {
  double mass;     ///< [kg/m]
  double stretch;  ///< force per strain, EA [N]
  double bend;     ///< EI [N·m²]
};
RopeNumbers numbers_of(const Rope& rope);

/// Start positions of the particles of a rope [m], and rest lengths of its pieces [m]: one piece less than particles,
/// or as many if the rope is closed.
struct RopeShape {
  std::vector<Vec3> places;
  std::vector<double> lengths;
};
/// Start shape of a rope. A slack rope without points hangs as a catenary. `up`: of the scene.
RopeShape start_shape(const Rope& rope, UpAxis up);

/// Default and minimum length of a piece, in diameters.
inline constexpr double kRopePiece = 3, kMinRopePiece = 1.5;
/// Minimum distance, across the up axis, between the ends of a slack rope without points, in diameters.
inline constexpr double kMinRopeSpan = 4;
/// Whether a rope has no points and is longer than the distance of its ends.
bool hangs_slack(const Rope& rope);

/// Length at the start [m]; empty: that of its course.
std::optional<double> start_length(const Rope& rope);

/// The one-dimensional cloth that is simulated for a rope.
Cloth as_cloth(const Rope& rope);
/// Appends the cloths of all ropes to those of the scene.
void add_rope_cloths(Scene& scene);
/// Removes the cloths of ropes.
void remove_rope_cloths(Scene& scene);

}  // namespace weft::scene
