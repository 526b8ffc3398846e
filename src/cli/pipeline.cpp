#include "cli/pipeline.hpp"

#include <optional>
#include <thread>
#include <utility>

#include "core/bounded_queue.hpp"
#include "core/timer.hpp"

namespace weft::cli {
namespace {

// Enough for one stage to ride out a slow frame of another; a picture of 1280×720 takes 2.7 MB.
constexpr std::size_t kQueueLength = 4;

struct DrawnFrame {
  frame::SnapshotPtr snapshot;
  image::Image image;
};

// Fields of a FrameRecord are written by the stage they belong to; the queues order writes before reads.
class Pipeline {
 public:
  Pipeline(const PipelineParts& parts, const FrameRange& made, const FrameRange& wanted, const std::atomic<bool>& stop,
           const PipelineObserver& observer)
      : parts_(parts), made_(made), wanted_(wanted), stop_(stop), observer_(observer) {
    result_.frames.resize(static_cast<std::size_t>(made.count()));
  }

  PipelineResult run() {
    {
      const std::jthread simulating([this] { simulate(); });
      std::jthread drawing;
      try {
        drawing = std::jthread([this] { draw(); });
      } catch (...) {
        snapshots_.cancel();  // else the simulation would wait for ever for someone to draw
        throw;
      }
      write();
    }
    result_.frames.resize(static_cast<std::size_t>(made_so_far_));
    return std::move(result_);
  }

 private:
  FrameRecord& record(int frame) {
    return result_.frames[static_cast<std::size_t>((frame - made_.begin) / made_.step)];
  }

  void simulate() noexcept {
    try {
      const std::unique_ptr<FrameSource> source = parts_.make_source();
      // The first one costs little more, so even a run that is stopped at once has a picture.
      for (int frame = made_.begin; frame <= wanted_.last(); frame += made_.step) {
        if (frame > made_.begin && stop_) {
          result_.interrupted = true;
          break;
        }
        SimulatedFrame simulated = source->next();
        record(frame).report = simulated.report;
        if (++made_so_far_ == 1) first_frame_ = source->first_frame();
        observer_.stage_done(Stage::simulate);
        if (!wanted_.contains(frame)) {
          observer_.frame_done(record(frame));
        } else if (!snapshots_.push(std::move(simulated.snapshot))) {
          break;
        }
      }
      snapshots_.close();
    } catch (...) {
      snapshots_.close(std::current_exception());
    }
  }

  void draw() noexcept {
    try {
      const std::unique_ptr<FramePainter> painter = parts_.make_painter();
      result_.painter = painter->description();
      while (frame::SnapshotPtr snapshot = snapshots_.pop().value_or(nullptr)) {
        if (first_frame_) painter->frame_on(*std::exchange(first_frame_, nullptr));
        DrawnFrame drawn{snapshot, painter->draw(*snapshot)};
        record(snapshot->frame).render = painter->last_time();
        observer_.stage_done(Stage::draw);
        if (!pictures_.push(std::move(drawn))) break;
      }
      pictures_.close();
    } catch (...) {
      pictures_.close(std::current_exception());
    }
    snapshots_.cancel();
  }

  void write() {
    std::unique_ptr<FrameWriter> writer;
    try {
      while (const std::optional<DrawnFrame> drawn = next_picture()) {
        if (!writer) writer = parts_.make_writer(result_.painter);
        write_one(*writer, *drawn);
      }
      if (writer) writer->finish();
      result_.finished_output = writer != nullptr;
    } catch (...) {
      result_.failure = std::current_exception();
    }
    pictures_.cancel();
  }

  // A failure upstream ends the line like its last frame does: what came before is still finished.
  std::optional<DrawnFrame> next_picture() {
    try {
      return pictures_.pop();
    } catch (...) {
      result_.failure = std::current_exception();
      return std::nullopt;
    }
  }

  void write_one(FrameWriter& writer, const DrawnFrame& drawn) {
    const WallTimer wall;
    const double cpu = thread_cpu_seconds();
    writer.write(*drawn.snapshot, drawn.image);
    FrameRecord& frame = record(drawn.snapshot->frame);
    frame.meshes = writer.last_extra_time();
    frame.encode = {wall.seconds() - frame.meshes.wall_s, thread_cpu_seconds() - cpu - frame.meshes.cpu_s};
    frame.written = true;
    ++result_.written;
    observer_.stage_done(Stage::write);
    observer_.frame_done(frame);
  }

  const PipelineParts& parts_;
  const FrameRange made_, wanted_;
  const std::atomic<bool>& stop_;
  const PipelineObserver& observer_;
  BoundedQueue<frame::SnapshotPtr> snapshots_{kQueueLength};
  BoundedQueue<DrawnFrame> pictures_{kQueueLength};
  frame::SnapshotPtr first_frame_;  // from the simulating to the drawing thread, before the first snapshot
  int made_so_far_ = 0;             // by the simulating thread; read after it has ended
  PipelineResult result_;
};

}  // namespace

PipelineResult run_pipeline(const PipelineParts& parts, const FrameRange& made, const FrameRange& wanted,
                            const std::atomic<bool>& stop, const PipelineObserver& observer) {
  return Pipeline(parts, made, wanted, stop, observer).run();
}

}  // namespace weft::cli
