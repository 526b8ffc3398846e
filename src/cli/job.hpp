// What run, simulate and render share: frames through the pipeline, from the options to the exit code.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cache/manifest.hpp"
#include "cli/event_log.hpp"
#include "cli/options.hpp"
#include "cli/output_target.hpp"
#include "cli/pipeline.hpp"
#include "cli/run_report.hpp"
#include "cli/signals.hpp"
#include "core/timer.hpp"
#include "render/renderer.hpp"

namespace weft::cli {

class Job {
 public:
  explicit Job(const RunOptions& options);
  virtual ~Job() = default;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  ExitCode execute();

 protected:
  /// What is made and where it goes.
  struct Plan {
    cache::Manifest scene;
    std::string scene_text;  ///< the effective scene
    FrameRange made;         ///< by the source
    FrameRange wanted;       ///< of those: drawn, or written as meshes
    int simulated = 0;       ///< frames that are, those before frame 0 too; 0 where frames are only read
    OutputTarget target;
    render::Settings settings;
  };

  /// Everything that can be refused is refused here, before any work is done.
  virtual Plan prepare() = 0;
  /// In the thread of the source. `proceed` is to be asked before each frame of a preroll.
  virtual std::unique_ptr<FrameSource> make_source(std::function<bool()> proceed) = 0;
  /// Once the source is there.
  virtual std::vector<frame::ObjectInfo> objects() const = 0;
  virtual std::unique_ptr<FramePainter> make_painter() const;
  /// After all frames.
  virtual void conclude(RunReport&) {}
  /// After the report is out.
  virtual void finish(ExitCode) {}
  /// What can be done after an early end; empty where there is nothing.
  virtual std::string way_on(ExitCode) const { return ""; }

  /// Throws Error(output_failed) where meshes are asked for and cannot be written.
  void prepare_meshes(const std::vector<std::string>& objects, const FrameRange& wanted, bool overwrite) const;
  const Plan& plan() const { return plan_; }

  const RunOptions& options_;

 private:
  void describe();
  PipelineResult run_stages();
  std::unique_ptr<FrameSource> set_up_source(const std::function<void()>& preroll_frame_done);
  void sum_up(const PipelineResult& result);
  void end_early(ExitCode code, const std::string& reason);
  void publish();
  template <class Write>
  void try_side_file(const Write& write);
  std::filesystem::path effective_scene_file() const;

  const WallTimer wall_;
  const StopSignals signals_;
  EventLog log_;
  Plan plan_;
  RunReport report_;
};

}  // namespace weft::cli
