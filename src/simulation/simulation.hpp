// The step loop: joins environment, forces, integrator and collision; emits snapshots.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

/// What the computation of one frame took and found.
struct FrameReport {
  int frame = 0;
  double time = 0;  ///< [s]
  double simulate_wall_s = 0, simulate_cpu_s = 0;
  double collide_wall_s = 0, collide_cpu_s = 0;  ///< part of simulate
  int steps = 0;                                 ///< accepted
  int rejected_steps = 0;                        ///< done again, shorter
  int inexact_steps = 0;                         ///< accepted although their error was above time.tolerance
  double error_estimate = 0;  ///< sum over the steps of what each adds to the error of positions [m], estimated
  int newton_iterations = 0;
  int linear_iterations = 0;
  int proximities = 0;          ///< pairs of features within 1.5 contact ranges at the start of the last step
  int constraints = 0;          ///< contacts and pins that acted in the last step
  double min_distance = 0;      ///< least distance of two surfaces then [m]; infinite if none is within that
  double max_strain = 0;        ///< largest |length / rest length - 1| of a weft or warp edge
  double kinetic_energy = 0;    ///< [J]
  double potential_energy = 0;  ///< of gravity, zero at the origin [J]
  double elastic_energy = 0;    ///< stretch, shear and bending [J]
  int pinched_pairs = 0;        ///< most triangles of cloth at once that have no room and are in an obstacle
  std::vector<std::string>
      pinches;  ///< those that begin: "frame 37: 'sheet' has no room between ..., near (x, y, z) m"
};

struct ObjectInfo {
  std::string name;
  frame::ObjectKind kind;
  std::size_t vertices = 0, faces = 0;
};

/// All particles, cloth by cloth in the order of the scene.
struct ParticleState {
  std::span<const Vec3> positions, velocities;  ///< [m], [m/s]
  std::span<const double> masses;               ///< [kg]
};

/// One line of `weft check --plan`: a part and whether this scene needs it.
struct PlanItem {
  std::string part;
  bool used = false;
  std::string reason;
};

/// What a simulation of this scene is put together from; builds nothing, and reads no file but those of characters,
/// whose memory is known from them alone. Throws Error(asset_unreadable, scene_invalid) where they cannot be used.
std::vector<PlanItem> plan(const scene::Scene& scene);

class Simulation {
 public:
  /// Builds only what the scene names. Throws Error (asset_unreadable, scene_invalid).
  explicit Simulation(const scene::Scene& scene);
  ~Simulation();

  /// The current frame; frame 0 after construction.
  frame::SnapshotPtr snapshot() const;

  /// Goes on to the next frame. Throws Error(simulation_failed) with a named reason if it cannot; the state is then
  /// still that of the last good frame.
  FrameReport advance();

  /// The report of frame 0: energies and distances of the start.
  FrameReport initial_report() const;

  /// Simulates time.preroll up to frame 0; without it advance() begins there. `proceed` is asked before each frame of
  /// it. Returns false where it said no: then there is no frame yet. Throws as advance() does.
  bool run_preroll(const std::function<bool()>& proceed = [] { return true; });
  std::vector<ObjectInfo> objects() const;
  std::size_t particles() const;
  /// Of the current frame; valid until the next advance().
  ParticleState state() const;

  /// Appends all that later frames depend on, in a form for machines of one kind and one version of the program. Not
  /// after a failed advance().
  void save(std::string& bytes) const;
  /// Goes on from what a simulation of the same scene has saved: what follows has the same bits. Only before the first
  /// advance(). Throws std::runtime_error where the bytes are none of this scene; the simulation is then of no use.
  void restore(std::string_view bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::simulation
