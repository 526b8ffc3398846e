// Simulates a scene frame by frame: snapshots, reports, and saved states.
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

/// FrameReport::stretch_ratio above which a run warns.
inline constexpr double kMaxStretchRatio = 1.1;

using frame::FrameReport;
using frame::ObjectInfo;

/// All particles of the cloths that are put on, cloth by cloth in the order of the scene.
struct ParticleState {
  std::span<const Vec3> positions, velocities;  ///< [m], [m/s]
  std::span<const double> masses;               ///< [kg]
};

/// Velocities and strains of a cloth in a frame; empty until the cloth is put on.
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

/// Lists the parts of which a simulation of this scene consists, without building it. Reads only the files of
/// characters (size of key frames), meshes and fitted patterns (rest shapes). Throws Error(asset_unreadable,
/// scene_invalid) if they cannot be used.
std::vector<PlanItem> plan(const scene::Scene& scene);

/// Warnings of `weft check`, one text each: settings that may end a run, or that the author hardly intends. If the
/// scene has moving pins, throws as Simulation's constructor does.
std::vector<std::string> find_warnings(const scene::Scene& scene);

/// A place where two objects, or one object and itself, touch or cross at the start.
struct IntersectionPlace {
  std::string a, b;                            ///< the objects
  std::size_t pairs = 0;                       ///< number of pairs of triangles
  Vec3 centre = Vec3::Zero();                  ///< [m]
  double size = 0;                             ///< longest side of the bounding box [m]
  std::vector<std::array<Vec3, 3>> triangles;  ///< those that meet there [m]
};

/// The start of a scene before its preroll, even if a run from it would be refused.
struct StartView {
  frame::SnapshotPtr snapshot;
  std::vector<IntersectionPlace> places;  ///< largest number of pairs first; empty if a run may begin
  std::string description;                ///< describes the places, for a message; empty if there are none
};

/// Makes the start as the scene gives it, without untangling; layers are not checked against each other. Throws
/// Error(asset_unreadable, scene_invalid).
StartView view_start(const scene::Scene& scene);

/// Size of the matrix of one Newton iteration, without contacts.
struct MatrixSize {
  std::size_t full_blocks = 0;       ///< 3×3 blocks, diagonal included
  std::size_t isotropic_blocks = 0;  ///< multiples of the identity, one number each
};

class Simulation {
 public:
  /// Builds only what the scene needs. Throws Error(asset_unreadable, scene_invalid).
  explicit Simulation(const scene::Scene& scene);
  ~Simulation();

  /// The current frame. After construction: frame 0, or the first frame of the preroll (with a negative number).
  frame::SnapshotPtr snapshot() const;

  /// Simulates the next frame. If that fails, keeps the last snapshot and throws Error(simulation_failed) with the
  /// reason, or Error(scene_invalid) if a cloth that is put on or closed in this frame does not fit.
  FrameReport advance();

  /// The report of frame 0: energies and distances of the start.
  FrameReport initial_report() const;

  /// Simulates time.preroll up to frame 0; without this call, advance() begins with the preroll. Calls `proceed` before
  /// each frame, and returns false as soon as that does: frame 0 is then not reached. Throws as advance() does.
  bool run_preroll(const std::function<bool()>& proceed = [] { return true; });
  std::vector<ObjectInfo> objects() const;
  std::size_t particles() const;
  MatrixSize matrix() const;
  /// State of the current frame, for the cloths that are put on; valid until the next advance().
  ParticleState state() const;
  /// `cloth`: number in the scene. The result is valid until the next advance().
  ClothMotion motion_of(std::size_t cloth) const;
  /// Total contact force on each particle [N] at the end of the last step, per cloth; empty until the cloth is put on.
  std::vector<std::vector<Vec3>> contact_forces() const;

  /// Moves an obstacle (number in the scene) to `end` at constant velocity during the next frame, whatever the scene
  /// says of its motion; it then stays there. The obstacle must have two keys or more.
  void drive(std::size_t obstacle, const scene::Pose& end);

  /// Appends everything that later frames depend on. Only machines of one kind and one version of the program can read
  /// it. Not allowed after a failed advance().
  void save(std::string& bytes) const;
  /// Restores what a simulation of the same scene has saved; the frames that follow have the same bits. Only allowed
  /// before the first advance(). If obstacles were driven, first call drive() once for each of them, to any pose.
  /// Throws std::runtime_error if the bytes do not fit this scene; the simulation is then unusable.
  void restore(std::string_view bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::simulation
