// The frame cache that a run fills while it simulates, and from which --resume continues. The *looks* of a scene are
// its colours, cameras and lights; its motion does not depend on them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/timer.hpp"
#include "film/cache/reader.hpp"
#include "film/cache/writer.hpp"
#include "film/production/scene_simulation.hpp"
#include "tools/cli/run_report.hpp"

namespace weft::cli {

/// A frame that a FrameSource has made.
struct MadeFrame {
  frame::SnapshotPtr snapshot;
  simulation::FrameReport report;
  bool needs_storing = false;  ///< not in the cache yet, or stored there with looks that have changed since
  const production::SceneSimulation* simulation = nullptr;  ///< the simulation, which is in the state of this frame;
                                                            ///< null if `snapshot` was read
};

class Store {
 public:
  enum class Need {
    required,  ///< a storage failure ends the run
    helpful,   ///< if storing fails or the disk is nearly full, the store warns and stops; the run continues
  };

  /// Locks `folder` against other writers. Throws Error(output_failed).
  Store(std::filesystem::path folder, Need need, cache::Manifest manifest, std::string scene_text);
  /// Removes the folder if it is empty.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Number of frames of an earlier run; 0 if its cache cannot be read.
  std::size_t leftover_frames() const;
  bool has_leftover() const { return cache::is_cache(lock_.folder()); }

  /// Finds the frame from which the earlier run can be resumed. If files are damaged, reports them; the run then starts
  /// at the beginning. Throws Error(output_failed) if the scene has changed in more than its looks since the earlier
  /// run, or if another build of the program made the cache.
  void find_start();
  /// Whether find_start() found a state to resume from.
  bool resumes() const { return reader_ != nullptr; }
  /// Removes the files of an earlier run.
  void clear() const { lock_.clear(); }

  /// The outputs of the run that is resumed, as PathLedger::outputs(). Their existing files may be replaced.
  std::set<std::string> outputs() const;
  /// Whether a file is the effective scene of the resumed run, unchanged since that run wrote it.
  bool holds_scene(const std::filesystem::path& file) const;
  /// Adds `outputs` to those that outputs() returns, in a file of the cache.
  void note_outputs(std::set<std::string> outputs) const;

  /// The cache of the earlier run; call it only if resumes().
  const cache::Reader& earlier() const { return *reader_; }
  /// Whether the earlier run stored this frame and all before it with the current looks; call it only if resumes().
  bool holds(int frame) const { return frame < current_frames_; }
  /// The stored state, from which the simulation continues; call it only if resumes().
  const cache::SolverState& start() const { return start_; }

  /// Starts storing frames of these objects. While make_film() runs, only its simulating thread may call open() and the
  /// functions below.
  void open(std::vector<frame::ObjectInfo> objects);
  /// Stores the frame if MadeFrame::needs_storing. Calls save_if_cheap() if the frame is simulated.
  void keep(const MadeFrame& frame);
  /// Reads a frame that this run or an earlier one has stored.
  frame::SnapshotPtr stored(int frame);
  /// Saves the state of the last kept frame if it was simulated. If saving fails, an earlier state remains.
  void keep_last_state();
  /// Saves the state of the simulation if this run has saved none yet, or if the last save took at most 1 % of the wall
  /// time since then.
  void save_if_cheap(const production::SceneSimulation& simulation, int frame);
  void save(const production::SceneSimulation& simulation, int frame);

  const std::filesystem::path& folder() const { return lock_.folder(); }
  /// Removes the folder. No frame may be added at the same time.
  void remove();
  const std::vector<frame::ObjectInfo>& objects() const { return manifest_.objects; }
  /// Whether a state is stored, from which --resume can continue.
  bool can_resume() const { return saved_frame_ || reader_; }
  StageTime time() const { return time_; }
  std::uintmax_t bytes() const { return writer_ ? writer_->bytes_added() : 0; }

 private:
  void note_former_looks(const cache::Manifest& found);
  void stop_storing(const std::string& reason);
  template <class Write>
  void attempt(const Write& write);

  const Need need_;
  cache::Manifest manifest_;
  const std::string scene_text_;
  cache::Lock lock_;
  std::unique_ptr<cache::Reader> reader_;      // of the earlier run
  std::unique_ptr<cache::Reader> now_reader_;  // of this run
  cache::SolverState start_;
  int current_frames_ = 0;  // frames 0 to current_frames_ − 1 of the earlier run have the current looks
  std::unique_ptr<cache::Writer> writer_;
  std::string state_;  // buffer, kept to reuse its memory
  WallTimer since_save_;
  double save_seconds_ = 0;  // wall time of the last save [s]
  std::optional<int> saved_frame_;
  const production::SceneSimulation* simulation_ = nullptr;  // its state is that of frame last_
  int last_ = 0;
  StageTime time_;
};

}  // namespace weft::cli
