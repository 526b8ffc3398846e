// The frame cache that a run fills while it works, and where a run before it stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cache/reader.hpp"
#include "cache/writer.hpp"
#include "cli/pipeline.hpp"
#include "core/timer.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {

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

  /// The cache of the earlier run; call resumes() first.
  const cache::Reader& earlier() const { return *reader_; }
  /// Of the last frame that is not simulated again; call resumes() first.
  const cache::SolverState& start() const { return start_; }

  /// Everything from here on is called by one thread, the simulating one.
  void open(std::vector<frame::ObjectInfo> objects);
  void add(const SimulatedFrame& frame);
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
  void give_up(const std::string& reason);
  template <class Write>
  void attempt(const Write& write);

  const Need need_;
  cache::Manifest manifest_;
  const std::string scene_text_;
  cache::Lock lock_;
  std::unique_ptr<cache::Reader> reader_;
  cache::SolverState start_;
  std::unique_ptr<cache::Writer> writer_;
  std::string state_;  // kept for its memory
  WallTimer since_save_;
  double save_seconds_ = 0;  // of the last save
  std::optional<int> saved_frame_;
  StageTime time_;
};

/// Frames of a scene: those that the store has, then those that are simulated, which it is given.
class StoredSimulation : public FrameSource {
 public:
  /// `proceed` is asked before each frame of the preroll.
  StoredSimulation(const scene::Scene& scene, Store& store, std::function<bool()> proceed);
  /// Keeps the state of the last frame.
  ~StoredSimulation() override;

  SimulatedFrame next() override;
  frame::SnapshotPtr first_frame() const override { return first_frame_; }

 private:
  SimulatedFrame make();
  void prepare_simulation();
  void run_preroll();

  const scene::Scene& scene_;
  Store& store_;
  const std::function<bool()> proceed_;
  std::unique_ptr<simulation::Simulation> simulation_;
  frame::SnapshotPtr first_frame_;
  int next_ = 0;
  bool good_ = false;  // the simulation stands at a whole frame
};

}  // namespace weft::cli
