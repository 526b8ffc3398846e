// Simulates a scene, and makes a snapshot of each frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/production/snapshots.hpp"
#include "film/scene/scene.hpp"
#include "physics/simulation/simulation.hpp"

namespace weft::production {

class SceneSimulation : public simulation::Simulation {
 public:
  /// If a garment cannot be untangled from its wearer, the wearer grows into it (environment/growing.hpp). Throws
  /// Error(asset_unreadable, scene_invalid). Warns of pins that jump or move too fast.
  explicit SceneSimulation(const scene::Scene& scene);

  /// The current frame. After construction: frame 0, or the first frame of the preroll (with a negative number). Made
  /// when it is first asked for.
  frame::SnapshotPtr snapshot() const;
  std::vector<frame::ObjectInfo> objects() const;

 private:
  struct Start;
  explicit SceneSimulation(Start start);
  std::vector<std::vector<float>> heat() const;

  SnapshotMaker maker_;
  scene::HeatQuantity heat_;
  mutable frame::SnapshotPtr current_;
  mutable std::uint64_t current_changes_ = 0;  // changes() when `current_` was made
};

/// The start of a scene before its preroll, even if a run would refuse it.
struct StartView {
  frame::SnapshotPtr snapshot;
  std::vector<simulation::IntersectionPlace> places;  ///< as of simulation::find_start_intersections()
  std::string description;                            ///< describes the places, for a message; empty if there are none
};

/// Makes the start as the scene gives it, without untangling. Throws Error(asset_unreadable, scene_invalid).
StartView view_start(const scene::Scene& scene);

}  // namespace weft::production
