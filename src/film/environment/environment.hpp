// Converts a scene to its simulated model, and to the data that are only drawn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/types.hpp"
#include "film/assets/mesh_file.hpp"
#include "film/character/character.hpp"
#include "film/environment/actor.hpp"
#include "film/environment/made_cloth.hpp"
#include "film/scene/scene.hpp"
#include "physics/model/model.hpp"

namespace weft::environment {

/// Data of an obstacle or character that are not in the simulated model.
struct BodyDetails {
  scene::Look look;
  std::shared_ptr<const character::Coloring> coloring;  ///< from the file of a character; null if the file has none
  std::vector<Part> parts;                              ///< parts of a character; empty for obstacles
  std::vector<std::uint8_t> passed_through;  ///< per triangle: 1 if its part does not collide; empty: no such part
};

/// The mesh of an obstacle in its own coordinates, and the UVs of its file. Throws as Environment() does.
assets::LoadedMesh mesh_of(const scene::Scene& scene, const scene::Obstacle& obstacle);

struct Followers;

/// All objects of a scene: the simulated model, and the data that are only drawn.
class Environment {
 public:
  /// Makes meshes and motions. Throws Error(asset_unreadable, scene_invalid) with file and scene line.
  explicit Environment(const scene::Scene& scene);

  model::Model model;                ///< bodies: those of scene.obstacles, followed by those of scene.characters
  std::vector<ClothDetails> cloths;  ///< one per cloth of the model
  std::vector<BodyDetails> bodies;   ///< one per body of the model
  std::vector<model::Parent> camera_parents;  ///< one per camera; empty if no camera follows anything

 private:
  /// For each scene::Attachment of one cloth, its particles.
  using Attached = std::vector<std::vector<model::WeightedParticle>>;
  std::vector<Attached> add_cloths(const scene::Scene& scene);
  void add_parents(const scene::Scene& scene);
  void add_characters(const scene::Scene& scene);
  void add_part_parents(const scene::Scene& scene, const scene::Character& character, const Followers& followers,
                        const motion::KeyFrames& keys);
  void add_pin_motions(const scene::Scene& scene);
  void add_attachments(const scene::Scene& scene, const std::vector<Attached>& attached);
};

}  // namespace weft::environment
