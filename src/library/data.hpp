// The data behind the public classes, for the library and the Python module.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>
#include <weft/scene.hpp>
#include <weft/simulation.hpp>

#include "core/error.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"
#include "simulation/frame_report.hpp"

namespace weft {

struct Scene::Data {
  scene::Scene scene;
  std::string text;            ///< TOML as given
  std::filesystem::path file;  ///< as given
  std::vector<std::string> changes;
};

struct Frame::Data {
  frame::SnapshotPtr snapshot;
  Report report;
  std::vector<std::vector<Vec3>> velocities;      ///< per cloth
  std::vector<std::vector<float>> strains;        ///< per cloth
  std::vector<std::vector<Vec3>> contact_forces;  ///< per cloth
  std::vector<Object> objects;                    ///< views of the members above
};

}  // namespace weft

namespace weft::library {

Report report_of(const simulation::FrameReport& report);

/// Makes a frame. Its objects are views of `data`.
Frame make_frame(Frame::Data data);

/// Throws the public exception that corresponds to an error of the program.
[[noreturn]] void throw_public(const Error& error);

/// Returns what `work` returns. If `work` throws Error, throws the corresponding exception of errors.hpp.
template <class Work>
auto with_public_errors(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw_public(error);
  }
}

}  // namespace weft::library
