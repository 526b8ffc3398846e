// Simulates a model or a scene, frame by frame.
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
  /// Names of the rigid bodies that Simulation::move() will move. They must have no mass.
  /// Exception: in a scene, a body with a mass may be driven until its `release`, if that is later
  /// than 0 s. From then on, forces move it; its `velocity` and `spin` are added to the velocity
  /// that Simulation::move() gave it.
  std::vector<std::string> driven{};
  std::string state{};  ///< result of Simulation::save() from which to continue; empty: begin at frame 0
};

/// Only one thread at a time may use a simulation; different simulations may run in different
/// threads. Results have the same bits for any number of threads (set_threads()).
class WEFT_API Simulation {
 public:
  /// Begins the simulation of a model. Throws std::invalid_argument if a value of the model is not
  /// valid or the options do not fit the model, and SceneError if surfaces touch at the start.
  explicit Simulation(const Model& model, const SimulationOptions& options = {});
  /// Begins the simulation of a scene; only in the library with scenes (weft/scene.hpp). If
  /// `options.state` is empty, computes the scene's `time.preroll` first. Throws SceneError if an
  /// object of the scene cannot be made or surfaces touch at the start, FileError if a file of the
  /// scene cannot be used, SimulationError if the preroll fails, and std::invalid_argument if the
  /// options do not fit the scene.
  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// The current frame. advance() replaces the frame to which the reference refers; to keep a frame,
  /// copy it.
  const Frame& frame() const;
  /// Computes the next frame; also allowed after the last frame of a scene. Throws SimulationError
  /// if the simulation cannot continue. Throws SceneError if a cloth with a given amount of air is
  /// closed in this frame (at the end of sewing) but encloses no volume. If advance() throws,
  /// frame() stays as it was.
  const Frame& advance();

  /// During the next frame, moves a driven body to `pose` at constant velocity. Then the body stays
  /// there until another call moves it. Pins that follow the body move with it, so a body that does
  /// not collide can move cloth. Throws std::invalid_argument if the body is not driven, if a
  /// coordinate of the position is not within ±1e5 m, or if the rotation is not a unit quaternion.
  void move(std::string_view body, const Pose& pose);

  /// Sets gravity [m/s²] and the velocity of the air [m/s] from the next frame on. These values
  /// replace those of the model or scene, and the scene's `physics.keys`; gusts and fans of a scene stay.
  /// Throws std::invalid_argument if a component of gravity is not within ±1e5 m/s², or a component
  /// of the velocity is not within ±1000 m/s.
  void set_weather(const Vector& gravity, const Vector& wind);

  /// Returns the state on which later frames depend, for SimulationOptions::state. To restore the
  /// state, use the same model or scene, driven bodies, library version and CPU architecture. Do
  /// not call save() after advance() has thrown.
  std::string save() const;

  struct Impl;  ///< for the library itself

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
