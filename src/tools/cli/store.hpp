// The frame cache that a run fills while it works; also finds where an earlier run can be resumed.
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

/// A frame from its source.
struct MadeFrame {
  frame::SnapshotPtr snapshot;
  simulation::FrameReport report;
  bool fresh = false;                                       ///< not yet in the cache, or cached with former looks
  const production::SceneSimulation* simulation = nullptr;  ///< in the state of this frame; null if the frame was read
};

class Store {
 public:
  enum class Need {
    required,  ///< a storage failure ends the run
    helpful,   ///< if storing fails or the disk is nearly full, storing ends with a warning; the run continues
  };

  /// Locks `folder` against other writers. Throws Error(output_failed).
  Store(std::filesystem::path folder, Need need, cache::Manifest manifest, std::string scene_text);
  /// Removes the folder if nothing was written.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Number of frames that an earlier run has left.
  std::size_t leftover_frames() const;
  bool has_leftover() const { return cache::is_cache(lock_.folder()); }

  /// Finds the frame from which the earlier run can be resumed. If its files are damaged, reports them and starts at
  /// the beginning. Throws Error(output_failed) if the scene of the earlier run differs in more than looks, or if
  /// another build of the program made it.
  void find_start();
  /// Whether find_start() found a state to resume from.
  bool resumes() const { return reader_ != nullptr; }
  /// Removes what an earlier run has left.
  void clear() const { lock_.clear(); }

  /// The outputs of the run that is resumed; their existing files may be replaced.
  std::set<std::string> outputs() const;
  /// Whether a file is the effective scene of the run that is resumed, as that run has written it.
  bool holds_scene(const std::filesystem::path& file) const;
  /// Adds to outputs().
  void note_outputs(std::set<std::string> outputs) const;

  /// The cache of the earlier run; call it only if resumes().
  const cache::Reader& earlier() const { return *reader_; }
  /// Whether the cache has this frame and all earlier ones, with the current looks; call it only if resumes().
  bool holds(int frame) const;
  /// The stored state, from which the simulation continues; call it only if resumes().
  const cache::SolverState& start() const { return start_; }

  /// Starts storing frames of these objects. While a film is made, only the simulating thread may call open() and the
  /// functions below.
  void open(std::vector<frame::ObjectInfo> objects);
  /// Stores the frame if it is fresh, and from time to time the state of the simulation.
  void keep(const MadeFrame& frame);
  /// Reads a frame that was stored in this run or an earlier one.
  frame::SnapshotPtr stored(int frame);
  /// Saves the state of the last frame. If this fails, an earlier state remains.
  void keep_last_state();
  /// Saves the state if this run has saved none yet, or if the last save took at most 1 % of the wall time since then.
  void save_if_cheap(const production::SceneSimulation& simulation, int frame);
  void save(const production::SceneSimulation& simulation, int frame);

  const std::filesystem::path& folder() const { return lock_.folder(); }
  /// Removes the folder. Must not be called while frames are added.
  void remove();
  const std::vector<frame::ObjectInfo>& objects() const { return manifest_.objects; }
  /// Whether a state is stored.
  bool can_resume() const { return saved_frame_ || reader_; }
  StageTime time() const { return time_; }
  std::uintmax_t bytes() const { return writer_ ? writer_->bytes_added() : 0; }

 private:
  void note_former_looks(const cache::Manifest& found);
  void give_up(const std::string& reason);
  template <class Write>
  void attempt(const Write& write);

  const Need need_;
  cache::Manifest manifest_;
  const std::string scene_text_;
  cache::Lock lock_;
  std::unique_ptr<cache::Reader> reader_;      // of the earlier run
  std::unique_ptr<cache::Reader> now_reader_;  // of this run
  cache::SolverState start_;
  int current_frames_ = 0;  // number of frames, from frame 0 on, that the earlier run left with the current looks
  std::unique_ptr<cache::Writer> writer_;
  std::string state_;  // buffer, kept to reuse its memory
  WallTimer since_save_;
  double save_seconds_ = 0;  // of the last save
  std::optional<int> saved_frame_;
  const production::SceneSimulation* simulation_ = nullptr;  // in the state of frame last_
  int last_ = 0;
  StageTime time_;
};

}  // namespace weft::cli
