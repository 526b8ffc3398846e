// Simulates a scene, and makes snapshots of frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/production/snapshots.hpp"
#include "film/scene/scene.hpp"
#include "physics/simulation/simulation.hpp"

namespace weft::production {

/// The simulation of a scene's model, which also makes the snapshots of its frames.
class SceneSimulation : public simulation::Simulation {
 public:
  /// If the arms of a wearer (a character in a garment) go through the garment at the start, poses the arms in the
  /// sleeves or away from the body. If a garment cannot be untangled from its wearer, lets the wearer grow into the
  /// garment. For both, see film/environment/growing.hpp. Logs the warnings of find_undrawn() (plan.hpp) and
  /// find_jumps() (pin_warnings.hpp). Throws Error with the code asset_unreadable or scene_invalid.
  explicit SceneSimulation(const scene::Scene& scene);

  /// Snapshot of the current frame. A new one is made only if the simulation has changed since the last call. After
  /// construction, the current frame is frame 0 or, with a preroll, the first frame of the preroll, whose number is
  /// negative.
  frame::SnapshotPtr snapshot() const;
  /// As SnapshotMaker::with_looks().
  frame::SnapshotPtr with_looks(const frame::FrameSnapshot& snapshot) const { return maker_.with_looks(snapshot); }
  /// All objects: cloths and ropes, then obstacles and characters.
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

/// The start of a scene before its preroll, and where surfaces touch or cross there.
struct StartView {
  frame::SnapshotPtr snapshot;
  std::vector<simulation::IntersectionPlace> places;  ///< result of simulation::find_start_intersections()
  std::string description;                            ///< describes `places` for a message; empty if there are none
};

/// The start exactly as in the scene: neither untangles cloth nor poses wearers, and accepts surfaces that touch or
/// cross. Throws Error with the code asset_unreadable or scene_invalid.
StartView view_start(const scene::Scene& scene);

}  // namespace weft::production
