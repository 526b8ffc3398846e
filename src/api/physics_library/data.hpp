// The private data of the public classes, for both libraries and the Python module.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>
#include <weft/errors.hpp>
#include <weft/simulation.hpp>

#include "core/error.hpp"
#include "core/types.hpp"
#include "physics/simulation/simulation.hpp"

namespace weft::frame {
struct FrameSnapshot;
}

namespace weft {

struct Frame::Data {
  int number = 0;
  double time = 0;  ///< [s]
  Report report;
  std::vector<std::vector<Vec3>> velocities;      ///< per cloth
  std::vector<std::vector<float>> strains;        ///< per cloth
  std::vector<std::vector<Vec3>> contact_forces;  ///< per cloth
  std::vector<Object> objects;                    ///< views of the members above, and of `viewed` or `snapshot`
  std::shared_ptr<const void> viewed;             ///< owns positions and meshes; null for a simulation of a Scene
  std::shared_ptr<const frame::FrameSnapshot> snapshot;  ///< for drawing; null for a simulation of a Model
};

struct Simulation::Impl {
  /// Returns data with the objects of the current state. The data own the arrays that these objects view.
  using MakeFrame = std::function<Frame::Data(const simulation::Simulation& now)>;

  /// `heading_of_state`: first line of a saved state; see heading_of(). If `options.state` is
  /// empty, runs the preroll; else restores that state. Throws std::invalid_argument if the options
  /// do not fit the simulation.
  Impl(std::unique_ptr<simulation::Simulation> of, std::string heading_of_state, const SimulationOptions& options,
       MakeFrame make_frame);

  std::size_t body(std::string_view name) const;
  void update_current_frame(const simulation::FrameReport& report);
  void set_weather(const Vector& gravity, const Vector& wind);
  void restore(std::string_view bytes);

  std::unique_ptr<simulation::Simulation> simulation;
  std::string heading;
  std::vector<std::size_t> driven;  // indices of the driven bodies
  std::vector<Vector> weather;      // gravity and wind of the last call of set_weather(); empty: never called
  MakeFrame make_frame;
  std::optional<Frame> current;
};

}  // namespace weft

namespace weft::library {

/// A view of a list as values of another type, which must have the same layout.
template <class To, class From>
std::span<const To> view_as(const std::vector<From>& points) {
  static_assert(sizeof(To) == sizeof(From));
  return {reinterpret_cast<const To*>(points.data()), points.size()};
}

/// The names of a list of objects, such as cloths or bodies.
template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& entry : list) names.emplace_back(entry.name);
  return names;
}

/// Converts a report to one of the public interface.
Report report_of(const simulation::FrameReport& report);

/// Makes a frame of these data. Sets the velocities, strains and contact forces of the first
/// objects, which must be the cloths, to views of the members of `data`.
Frame make_frame(Frame::Data data);

/// First line of a saved state, with its line feed. It identifies the library version, the model or
/// scene (`hash`) and the driven bodies.
std::string heading_of(std::uint64_t hash, const SimulationOptions& options);

/// Throws the exception of weft/errors.hpp that corresponds to `error`, or std::runtime_error.
[[noreturn]] void throw_public(const Error& error);

/// Returns the result of `work`. If `work` throws Error, calls throw_public().
template <class Work>
auto with_public_errors(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw_public(error);
  }
}

}  // namespace weft::library
