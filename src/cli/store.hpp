// The frame cache that a run fills while it works, and where a run before it stopped.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cache/reader.hpp"
#include "cache/writer.hpp"
#include "cli/run_report.hpp"
#include "core/timer.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {

/// A frame from its source.
struct MadeFrame {
  frame::SnapshotPtr snapshot;
  simulation::FrameReport report;
  bool fresh = false;                                  ///< not in the cache yet, or with other looks
  const simulation::Simulation* simulation = nullptr;  ///< stands at this frame; null where the frame was read
};

class Store {
 public:
  enum class Need {
    required,  ///< what cannot be kept ends the run
    helpful,   ///< what cannot be kept, or takes the room of the other output, is given up with a warning
  };

  /// Nobody else writes to `folder` from now on. Throws Error(output_failed).
  Store(std::filesystem::path folder, Need need, cache::Manifest manifest, std::string scene_text);
  /// Leaves no folder where nothing was put in.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Frames that an earlier run has left.
  std::size_t leftover_frames() const;
  bool has_leftover() const { return cache::is_cache(lock_.folder()); }

  /// Looks up where the earlier run can be gone on with. What is broken is not used, and said. Throws
  /// Error(output_failed) where it is one of another scene or by another program.
  void find_start();
  /// There is something to go on with.
  bool resumes() const { return reader_ != nullptr; }
  /// Takes away what an earlier run has left.
  void clear() const { lock_.clear(); }

  /// The outputs of the run that goes on here: what is there of them is its own, and may be replaced when it goes on.
  std::set<std::string> outputs() const;
  /// Adds some.
  void note_outputs(std::set<std::string> outputs) const;

  /// The cache of the earlier run; call resumes() first.
  const cache::Reader& earlier() const { return *reader_; }
  /// Has it, and all before it, with the looks of now; call resumes() first.
  bool holds(int frame) const;
  /// Of the last frame that is not simulated again; call resumes() first.
  const cache::SolverState& start() const { return start_; }

  /// Everything from here on is called by one thread, the simulating one.
  void open(std::vector<frame::ObjectInfo> objects);
  /// Keeps what is fresh, and now and then the state of the simulation.
  void keep(const MadeFrame& frame);
  /// A frame that was kept, or read from the earlier run, again.
  frame::SnapshotPtr stored(int frame);
  /// That of the last frame. An earlier one is there where this one cannot be kept.
  void keep_last_state();
  /// Keeps the state where that has cost little so far for the work that it saves.
  void save_if_cheap(const simulation::Simulation& simulation, int frame);
  void save(const simulation::Simulation& simulation, int frame);

  const std::filesystem::path& folder() const { return lock_.folder(); }
  /// Not while frames are added.
  void remove();
  const std::vector<frame::ObjectInfo>& objects() const { return manifest_.objects; }
  /// A state is there.
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
  std::unique_ptr<cache::Reader> now_reader_;  // of this one
  cache::SolverState start_;
  std::unique_ptr<cache::Writer> writer_;
  std::string state_;  // kept for its memory
  WallTimer since_save_;
  double save_seconds_ = 0;  // of the last save
  std::optional<int> saved_frame_;
  const simulation::Simulation* simulation_ = nullptr;  // stands at last_
  int last_ = 0;
  StageTime time_;
};

}  // namespace weft::cli
