// Simulates a model or a scene frame by frame.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include <weft/api.hpp>
#include <weft/errors.hpp>
#include <weft/frame.hpp>
#include <weft/model.hpp>

namespace weft {

class Scene;

struct SimulationOptions {
  /// Names of the bodies that Simulation::move() moves: without a mass, or, in scenes, until their `release`.
  std::vector<std::string> driven{};
  std::string state{};  ///< result of save(), from which to continue; empty: begin at frame 0
};

/// A simulation at one frame. One thread at a time may use it; different simulations may run in different threads.
/// The same model or scene gives the same bits on any number of threads.
class WEFT_API Simulation {
 public:
  /// Builds the simulation. Throws std::invalid_argument if a value of the model is out of range, or the options do not
  /// fit the model; SceneError if surfaces touch at the start.
  explicit Simulation(const Model& model, const SimulationOptions& options = {});
  /// Only in the library with scenes (weft/scene.hpp). Builds the simulation and, if `options.state` is empty, computes
  /// the scene's `time.preroll`. Throws SceneError if surfaces touch at the start, FileError if a file of the scene
  /// cannot be used, SimulationError if the preroll fails, and std::invalid_argument if the options do not fit the
  /// scene.
  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  const Frame& frame() const;
  /// Computes the next frame, also beyond the last one of the scene. Throws SimulationError, or SceneError if a cloth
  /// that is put on or closed in this frame does not fit; frame() then stays as it was.
  const Frame& advance();

  /// Moves a driven body to `pose` at constant velocity during the next frame; it then stays there. Pins that follow it
  /// move along, so a body that does not collide can serve as a handle for cloth. Throws std::invalid_argument if the
  /// body is not driven, or the pose is not finite or has no unit quaternion.
  void move(std::string_view body, const Pose& pose);

  /// Sets gravity [m/s²] and the velocity of the air [m/s] from the next frame on, in place of those of the model or
  /// scene and their keys. Gusts and fans of a scene stay. Throws std::invalid_argument if a number is out of range.
  void set_weather(const Vector& gravity, const Vector& wind);

  /// Returns everything on which later frames depend. It can be restored with the same model or scene, options, library
  /// version and kind of machine. Not allowed after a failed advance().
  std::string save() const;

  struct Impl;  ///< for the library itself

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
