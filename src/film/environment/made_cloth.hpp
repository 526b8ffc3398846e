// Makes a cloth of a scene, as it is at the start of the run.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "film/environment/wearers.hpp"
#include "film/scene/scene.hpp"
#include "physics/mesh/sheet.hpp"
#include "physics/model/model.hpp"

namespace weft::environment {

/// Data of a cloth that are not in the simulated model.
struct ClothDetails {
  /// Per particle: its place in the cloth, two numbers from 0 to 1; see make_cloth().
  std::vector<Vec2> fractions;
  std::map<std::string, std::vector<Index>> edges;  ///< for patterns: particles of each edge, by "panel.edge"
  std::vector<std::string> panels;                  ///< for patterns: names of the panels
  std::vector<std::int32_t> panel_of;               ///< for patterns: index of the panel of each triangle
  /// For cloth sewn from panels: per triangle, the coordinates (weft, warp) of its corners in its panel [m].
  std::vector<std::array<Vec2, 3>> paint_uv;
  /// For patterns: per zip and per seam that can tear, the pairs of particles that it holds together, in order.
  std::vector<std::vector<std::array<Index, 2>>> closures;
  std::string fitted;     ///< for patterns that were scaled to their wearer: description of the scaling; else empty
  std::string rest_from;  ///< for mesh files: source of the rest shape, and the reason for the choice
  std::vector<std::string> warnings;
};

/// A cloth made from its table in the scene and, for some patterns, from the body of its wearer. Environment sets the
/// remaining data later: `put_on`, `over`, and the bodies and motions of pins.
struct MadeCloth {
  model::Cloth cloth;
  ClothDetails details;
  /// Particles of each scene::Attachment that names this cloth.
  std::vector<std::vector<model::WeightedParticle>> attachments;
};

/// Particle counts, spacings and gradings of a rectangular cloth.
mesh::Grid grid_of(const scene::Cloth& cloth);

/// Throws Error(scene_invalid) if the cells of a rectangular cloth are too uneven for contact with obstacles. Ignores
/// other cloths, and scenes in which no cloth can touch obstacles. make_cloth() calls this function, and similarly
/// checks the triangles of other cloths.
void check_spacing(const scene::Scene& scene, const scene::Cloth& cloth);

/// Makes a cloth as it is at the start. ClothDetails::fractions are measured along weft and warp of rectangular cloths,
/// along x and y in the bounding box of mesh files, along x and z in the bounding box of the start shape of patterns
/// (garment::Garment), and along ropes, with 0.5 as the second number. Throws Error(asset_unreadable, scene_invalid)
/// with the scene line.
MadeCloth make_cloth(const scene::Scene& scene, const scene::Cloth& cloth, Wearers& wearers);

}  // namespace weft::environment
