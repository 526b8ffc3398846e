// A scene from frame to frame: snapshots, reports, and states to go on from.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frame/frame_report.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

/// FrameReport::stretch_share above which a run warns.
inline constexpr double kOverstretch = 1.1;

using frame::FrameReport;
using frame::ObjectInfo;

/// All particles, cloth by cloth in the order of the scene.
struct ParticleState {
  std::span<const Vec3> positions, velocities;  ///< [m], [m/s]
  std::span<const double> masses;               ///< [kg]
};

/// What a frame shows of a cloth besides its positions; empty until the cloth is put on.
struct ClothMotion {
  std::span<const Vec3> velocities;  ///< per particle [m/s]
  std::vector<float> strains;        ///< per particle: largest relative change of length of the threads next to it
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

/// What may well end a run of this scene or is hardly meant, a sentence each: `weft check` says it beforehand. Throws
/// as Simulation's constructor does, for scenes with pins that move by keys.
std::vector<std::string> doubts(const scene::Scene& scene);

/// Where two objects, or one and itself, touch or cross at the start.
struct MeetingPlace {
  std::string a, b;                            ///< the objects
  std::size_t pairs = 0;                       ///< of triangles
  Vec3 centre = Vec3::Zero();                  ///< [m]
  double size = 0;                             ///< longest side of the box around it [m]
  std::vector<std::array<Vec3, 3>> triangles;  ///< that meet there [m]
};

/// How a scene starts, before its preroll, also where that would be refused.
struct StartView {
  frame::SnapshotPtr snapshot;
  std::vector<MeetingPlace> places;  ///< of most pairs first; empty where a run may begin
  std::string description;           ///< of the places, for a message; empty likewise
};

/// The start as the scene gives it: nothing is untangled, and layers do not meet each other. Throws
/// Error(asset_unreadable, scene_invalid).
StartView view_start(const scene::Scene& scene);

/// What the matrix of one iteration of Newton's method holds, contacts not counted.
struct MatrixSize {
  std::size_t full_blocks = 0;       ///< 3×3, diagonal included
  std::size_t isotropic_blocks = 0;  ///< multiples of the unit matrix, one number each
};

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
  MatrixSize matrix() const;
  /// Of the current frame, and of cloths that are put on by then; valid until the next advance().
  ParticleState state() const;
  /// Of a cloth of the scene, by number; valid until the next advance().
  ClothMotion motion_of(std::size_t cloth) const;
  /// Per cloth of the scene and particle, of all that it touches, at the end of the last step [N]; empty until the
  /// cloth is put on.
  std::vector<std::vector<Vec3>> contact_forces() const;

  /// In the next frame the obstacle, by its number in the scene, goes to `end` at constant velocity and stays there,
  /// whatever the scene says of its motion. Only for an obstacle that has two keys or more.
  void drive(std::size_t obstacle, const scene::Pose& end);

  /// Appends all that later frames depend on, in a form for machines of one kind and one version of the program. Not
  /// after a failed advance().
  void save(std::string& bytes) const;
  /// Goes on from what a simulation of the same scene has saved: what follows has the same bits. Before it, each
  /// obstacle that was driven must be driven once, to anywhere. Only before the first advance(). Throws
  /// std::runtime_error where the bytes are none of this scene; the simulation is then of no use.
  void restore(std::string_view bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::simulation
