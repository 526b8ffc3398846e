// All results of a run, for the statistics file and the summary.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/run_error/companions.hpp"
#include "tools/cli/frame_range.hpp"

namespace weft::cli {

/// The outcome of one frame.
struct FrameRecord {
  simulation::FrameReport report;
  bool written = false;  ///< all stages have completed the frame; false again if the video cannot be finished
  StageTime render, encode, meshes;
};

/// Number of particles of all cloths and ropes.
std::size_t count_particles(const std::vector<frame::ObjectInfo>& objects);

struct RunReport {
  std::string scene;  ///< its name
  std::string scene_file;
  std::uint64_t scene_hash = 0;
  std::vector<frame::ObjectInfo> objects;
  std::size_t particles = 0;
  /// Longest side of the bounding box of the largest cloth or rope in the first frame [m]; 0: none.
  double cloth_size = 0;
  int threads = 0;
  std::string gl;             ///< description of OpenGL; "none" if nothing is drawn
  int width = 0, height = 0;  ///< [pixels]; 0 if nothing is drawn
  double fps = 0;
  std::string output;               ///< path as the user typed it, or the default
  std::uintmax_t output_bytes = 0;  ///< of a video; 0 for pictures or none
  bool replayed = false;            ///< whether frames were read from a cache instead of simulated
  FrameRange wanted;                ///< frames to draw
  std::vector<FrameRecord> frames;  ///< simulated or read frames
  int written = 0;                  ///< number of frames with FrameRecord::written
  StageTime cache;                  ///< time for storing frames and states
  std::uintmax_t cache_bytes = 0;   ///< written to the cache
  StageTime setup;               ///< time for reading the scene and building the simulation, or for opening the cache
  double wall_s = 0, cpu_s = 0;  ///< of the whole process; cpu_s: sum over all threads
  std::int64_t peak_memory = 0;  ///< [bytes]
  std::vector<std::string> warnings;
  /// Remarks that need no action, such as that a body surface was moved to make space for cloth.
  std::vector<std::string> notes;
  ExitCode exit_code = ExitCode::ok;
  std::string message;                            ///< why the run ended early; empty if it did not
  std::optional<run_error::ErrorEstimate> error;  ///< if requested
};

/// Times of the stages, sums over the frames.
struct StageTotals {
  /// `collide`, `forces`, `preconditioner` and `linear` are parts of `simulate`.
  StageTime simulate, collide, forces, preconditioner, linear;
  StageTime render, encode, meshes;
};

StageTotals total_times(const std::vector<FrameRecord>& frames);

/// Counts and errors of the time steps, sums over the frames.
struct StepTotals {
  long long accepted = 0, rejected = 0;
  long long inexact = 0;      ///< accepted steps whose error exceeds the tolerance
  double error_estimate = 0;  ///< estimated error of the time steps [m]
  double solver_error = 0;    ///< error due to residuals of the solver [m]
};

StepTotals total_steps(const std::vector<FrameRecord>& frames);

}  // namespace weft::cli
