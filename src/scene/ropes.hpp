// Ropes as the rest of the program sees them: their material in numbers, how they start, and the cloth that stands for
// them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

/// Figures of a kind of rope, each for the square of its nominal diameter d [m].
struct RopeMaterial {
  std::string name;
  double mass;            ///< [kg/m per m²]
  double stretch;         ///< force per strain [N per m²]
  double bending_length;  ///< cube root of bending stiffness over weight, in diameters
};
const std::vector<RopeMaterial>& rope_materials();

/// Of one rope, those of its material where the scene does not say.
struct RopeNumbers {
  double mass;     ///< [kg/m]
  double stretch;  ///< force per strain, EA [N]
  double bend;     ///< EI [N·m²]
};
RopeNumbers numbers_of(const Rope& rope);

/// Where the particles of a rope start [m], and how long its pieces are at rest [m]: one piece less than particles, or
/// as many where it is closed.
struct RopeShape {
  std::vector<Vec3> places;
  std::vector<double> lengths;
};
/// `up`: the scene's. A slack rope without points hangs as a catenary.
RopeShape start_shape(const Rope& rope, UpAxis up);

/// Length of a piece, in diameters: by default, and at least.
inline constexpr double kRopePiece = 3, kLeastRopePiece = 1.5;
/// How far apart, across the up axis, the ends of a slack rope without points are at least, in diameters.
inline constexpr double kLeastRopeSpan = 4;
/// Whether it has no points and is longer than the distance of its ends.
bool hangs_slack(const Rope& rope);

/// At the start [m]; empty: as its course is.
std::optional<double> start_length(const Rope& rope);

/// The cloth of one dimension that is simulated.
Cloth as_cloth(const Rope& rope);
/// Appends the cloths of all ropes to those of the scene.
void add_rope_cloths(Scene& scene);
/// Takes them away again.
void remove_rope_cloths(Scene& scene);

}  // namespace weft::scene
