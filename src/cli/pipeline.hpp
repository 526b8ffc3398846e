// Three threads side by side: simulate, draw, write. Bounded queues between them keep the memory small.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/frame_range.hpp"
#include "core/progress.hpp"
#include "frame/frame_snapshot.hpp"
#include "image/image.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {

struct SimulatedFrame {
  frame::SnapshotPtr snapshot;
  simulation::FrameReport report;
};

struct StageTime {
  double wall_s = 0, cpu_s = 0;

  StageTime& operator+=(const StageTime& other) {
    wall_s += other.wall_s;
    cpu_s += other.cpu_s;
    return *this;
  }
};

/// First stage: yields one frame after the other. Throws when it cannot go on.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual SimulatedFrame next() = 0;
  /// Frame 0, once next() was called: automatic framing looks at it whichever frames are drawn.
  virtual frame::SnapshotPtr first_frame() const { return nullptr; }
};

/// Second stage.
class FramePainter {
 public:
  virtual ~FramePainter() = default;
  /// What automatic framing looks at; without it, at the first frame that is drawn.
  virtual void frame_on(const frame::FrameSnapshot&) {}
  virtual image::Image draw(const frame::FrameSnapshot& snapshot) = 0;
  virtual StageTime last_time() const = 0;
  virtual std::string description() const = 0;
};

/// Third stage. Without finish() it must leave no half file.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void write(const frame::FrameSnapshot& snapshot, const image::Image& image) = 0;
  virtual void finish() = 0;
  /// The part of the last write() that went into other files than the picture, such as meshes.
  virtual StageTime last_extra_time() const { return {}; }
};

/// What became of one frame.
struct FrameRecord {
  simulation::FrameReport report;
  bool written = false;  ///< drawn and written; false outside the wanted frames or after a failure
  StageTime render, encode, meshes;
};

/// Makers run in the thread of their stage, where the object also lives and dies (an OpenGL context belongs to one
/// thread). The writer is made for the first picture, when the painter's description is known.
struct PipelineParts {
  std::function<std::unique_ptr<FrameSource>()> make_source;
  std::function<std::unique_ptr<FramePainter>()> make_painter;
  std::function<std::unique_ptr<FrameWriter>(const std::string& painter_description)> make_writer;
};

/// Called from the threads of the stages.
struct PipelineObserver {
  std::function<void(Stage)> stage_done;               ///< a frame went through a stage
  std::function<void(const FrameRecord&)> frame_done;  ///< a frame is written, or simulated only
};

struct PipelineResult {
  std::vector<FrameRecord> frames;  ///< all that were made, in order
  int written = 0;
  bool interrupted = false;      ///< stopped on request before the last wanted frame
  std::string painter;           ///< its description; empty if none was made
  std::exception_ptr failure;    ///< of the stage nearest to the output, if any failed
  bool finished_output = false;  ///< what was written is whole, under its final name
};

/// Runs through the frames that the source makes until the last of `wanted`, `stop`, or a failure; `made` has all of
/// `wanted`. Whatever ends the run, the frames that were written are
/// finished and kept if the writer itself works. Never throws for a failure of a stage: see `failure`.
PipelineResult run_pipeline(const PipelineParts& parts, const FrameRange& made, const FrameRange& wanted,
                            const std::atomic<bool>& stop, const PipelineObserver& observer);

}  // namespace weft::cli
