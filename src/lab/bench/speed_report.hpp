// Tables, plots and a conclusion about the cost of runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/bench/report.hpp"
#include "lab/bench/speed.hpp"

namespace weft::bench {

/// Numbers of intersecting pairs of triangles.
struct FramePairs {
  std::int64_t worst = 0, last = 0;  ///< in the frame with the most pairs, in the last frame
};

/// Weft and a peer (another program) on one thread, at one size of the scene.
struct PeerRun {
  double size = 1;           ///< see SpeedSetting::size
  std::string failure = {};  ///< why there is no comparison; empty if there is one
  std::int64_t particles = 0;
  double weft_ms = 0, peer_ms = 0;  ///< CPU time of a frame: mean over the frames, median over repeated runs [ms]
  FramePairs weft_pairs = {}, peer_pairs = {};

  bool failed() const { return !failure.empty(); }
};

struct SpeedReport {
  std::string title, machine;  ///< `title` names the scene, `machine` the processor
  SpeedFrames frames;
  std::vector<SpeedRun> runs;
  std::string peer = {};  ///< name of the peer
  /// In order of size. The compared frames are 1 to frames.end - 1. Empty: there is no peer.
  std::vector<PeerRun> peer_runs = {};
};

/// One row per run, for other programs. Times are in milliseconds per frame. The field of an unknown value is empty.
Table speed_table(const std::vector<SpeedRun>& runs);

/// Successful runs with the smallest number of threads and the scene's step, in order of size.
std::vector<const SpeedRun*> over_sizes(const std::vector<SpeedRun>& runs);
/// Successful runs with this size and the scene's step, in order of the number of threads.
std::vector<const SpeedRun*> over_threads(const std::vector<SpeedRun>& runs, double size);
/// Successful runs with one size and one number of threads, from the longest step to the shortest. Both values are
/// those of the first run whose step is not the scene's. Empty if all runs have the scene's step.
std::vector<const SpeedRun*> over_steps(const std::vector<SpeedRun>& runs);

/// Exponent with which a value grows with the number of particles between two runs; nullopt unless `large` has more
/// particles and both values are positive.
std::optional<double> exponent(const SpeedRun& small, const SpeedRun& large, double of_small, double of_large);

/// Sentences: cost of a frame and its growth with size, speed-up by threads, memory, and the ratio of the memory bound
/// (memory_bound_s()) to the time of forces, preconditioner and linear solver.
std::string conclusion(const std::vector<SpeedRun>& runs);

std::string speed_svg(const SpeedReport& report);
/// The report. `plot`: name of the file with the plot, in the folder of the report.
std::string speed_markdown(const SpeedReport& report, const std::string& plot);

}  // namespace weft::bench
