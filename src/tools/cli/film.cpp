#include "tools/cli/film.hpp"

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

#include "core/bounded_queue.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "film/run_error/trajectory.hpp"
#include "tools/cli/stats.hpp"

namespace weft::cli {
namespace {

// Maximum number of frames in a queue. With several frames in a queue, one stage can continue while the next stage
// processes a slow frame. A picture of 1280×720 pixels takes 2.7 MB.
constexpr std::size_t kQueueLength = 4;

struct MadePair {
  frame::SnapshotPtr snapshot, before;
};

struct DrawnFrame {
  frame::SnapshotPtr snapshot;
  Picture picture;
};

// A frame passes through make_frames(), draw_frames() and write_frames(), each in its own thread. Each stage writes its
// own fields of a FrameRecord; the queues order these writes before later reads.
class Film {
 public:
  Film(const FilmParts& parts, const FrameRange& made, const FrameRange& wanted, const std::atomic<bool>& stop,
       Progress& progress, EventLog& log)
      : parts_(parts),
        made_(made),
        wanted_(wanted),
        stop_(stop),
        progress_(progress),
        log_(log),
        camera_(parts.camera) {
    result_.frames.resize(made.count());
  }

  FilmResult make() {
    {
      const std::jthread making([this] { make_frames(); });
      std::jthread drawing;
      try {
        drawing = std::jthread([this] { draw_frames(); });
      } catch (...) {
        snapshots_.cancel();  // otherwise make_frames() waits forever for the drawing thread
        throw;
      }
      write_frames();
    }
    result_.frames.resize(made_so_far_);
    return std::move(result_);
  }

 private:
  void make_frames() noexcept {
    try {
      const std::unique_ptr<FrameSource> source = open_source();
      if (camera_) {
        make_then_push(*source);
      } else {
        make_frames(*source, false);
      }
      snapshots_.close();
    } catch (...) {
      snapshots_.close(std::current_exception());
    }
  }

  /// Makes frames, and passes those that are to be drawn to the drawing thread. If `only_show` is true, passes all
  /// frames to the camera instead.
  void make_frames(FrameSource& source, bool only_show) {
    const int last = only_show ? made_.last() : wanted_.last();
    // Makes the first frame even after a stop request, so that the run has a picture.
    for (int frame = made_.begin; frame <= last; frame += made_.step) {
      if (frame > made_.begin && stop_) {
        result_.interrupted = true;
        break;
      }
      MadeFrame made = source.next();
      if (frame == made_.begin) result_.cloth_size = run_error::cloth_size(*made.snapshot);
      if (parts_.on_frame) parts_.on_frame(made);
      if (parts_.store) parts_.store->keep(made);  // so that --resume need not simulate it again
      for (const std::string& warning : made.report.warnings) log::warn(warning);
      record(frame).report = std::move(made.report);
      ++made_so_far_;
      progress_.advance(Stage::simulate);
      if (only_show) camera_->add_frame(*made.snapshot);
      if (!wanted_.contains(frame) || parts_.drawn.contains(frame)) {
        log_.write("frame_done", frame_json(record(frame)));
      } else if (!only_show && !push_to_drawing(made.snapshot, &source)) {
        break;
      }
      if (parts_.motion && (frame - wanted_.begin) % wanted_.step == 0) before_ = std::move(made.snapshot);
    }
    if (parts_.store) parts_.store->keep_last_state();
  }

  /// Passes a frame to the drawing thread, with the previous wanted frame if the painter needs it. Returns false if the
  /// drawing thread has ended.
  bool push_to_drawing(const frame::SnapshotPtr& snapshot, const FrameSource* source) {
    const int frame = snapshot->frame - wanted_.step;
    if (parts_.motion && !before_ && frame >= 0)
      before_ = source ? source->earlier(frame) : parts_.store->stored(frame);
    return snapshots_.push({snapshot, before_});
  }

  /// Makes all frames and passes them to the camera. Then reads the wanted frames from the store, and passes them to
  /// the drawing thread. If making frames fails, passes on the frames made so far.
  void make_then_push(FrameSource& source) {
    std::exception_ptr failure;
    try {
      make_frames(source, true);
    } catch (...) {
      failure = std::current_exception();
    }
    camera_->compute_cameras();
    before_ = nullptr;
    const bool stopped = result_.interrupted;
    for (int frame = wanted_.begin; frame <= wanted_.last() && frame < made_.begin + made_so_far_;
         frame += wanted_.step) {
      if (stop_ && !stopped && frame > wanted_.begin) {
        result_.interrupted = true;
        break;
      }
      const frame::SnapshotPtr snapshot = parts_.store->stored(frame);
      if (!push_to_drawing(snapshot, nullptr)) break;
      if (parts_.motion) before_ = snapshot;
    }
    if (failure) std::rethrow_exception(failure);
  }

  void draw_frames() noexcept {
    try {
      const std::unique_ptr<FramePainter> painter = parts_.open_painter ? parts_.open_painter() : nullptr;
      if (painter) result_.painter = painter->description();
      while (const std::optional<MadePair> made = snapshots_.pop()) {
        const frame::SnapshotPtr& snapshot = made->snapshot;
        DrawnFrame drawn{snapshot, {}};
        if (painter) {
          if (camera_) painter->set_camera_path(*std::exchange(camera_, std::nullopt));
          drawn.picture = painter->draw(*snapshot, made->before.get());
          record(snapshot->frame).render = painter->last_time();
        }
        progress_.advance(Stage::draw);
        if (!pictures_.push(std::move(drawn))) break;
      }
      pictures_.close();
    } catch (...) {
      pictures_.close(std::current_exception());
    }
    snapshots_.cancel();
  }

  void write_frames() {
    std::unique_ptr<FrameWriter> writer;
    try {
      while (const std::optional<DrawnFrame> drawn = next_picture()) {
        if (!writer && parts_.open_writer) writer = parts_.open_writer(result_.painter);
        FrameRecord& frame = record(drawn->snapshot->frame);
        if (writer) frame.encode = timed([&] { writer->write(*drawn->snapshot, drawn->picture); });
        if (!parts_.meshes.empty()) frame.meshes = timed([&] { write_meshes(parts_.meshes, *drawn->snapshot); });
        frame.written = true;
        ++result_.written;
        progress_.advance(Stage::write);
        log_.write("frame_done", frame_json(frame));
      }
      const bool finishes = writer && (parts_.keeps_partial_output || !result_.failure);
      if (finishes) writer->finish();
      result_.finished_output = finishes;
    } catch (...) {
      result_.failure = std::current_exception();
    }
    pictures_.cancel();
  }

  std::unique_ptr<FrameSource> open_source() {
    std::unique_ptr<FrameSource> source;
    result_.setup = timed([&] { source = parts_.open_source(); });
    result_.objects = source->objects();
    log_.write("simulation_ready",
               {{"objects", result_.objects.size()}, {"particles", count_particles(result_.objects)}});
    return source;
  }

  // The next drawn frame; nullopt after the last frame. If an earlier stage failed, stores the failure and returns
  // nullopt, so that the output is finished with the earlier frames.
  std::optional<DrawnFrame> next_picture() {
    try {
      return pictures_.pop();
    } catch (...) {
      result_.failure = std::current_exception();
      return std::nullopt;
    }
  }

  FrameRecord& record(int frame) { return result_.frames[(frame - made_.begin) / made_.step]; }

  const FilmParts& parts_;
  const FrameRange made_, wanted_;
  const std::atomic<bool>& stop_;
  Progress& progress_;
  EventLog& log_;
  BoundedQueue<MadePair> snapshots_{kQueueLength};
  BoundedQueue<DrawnFrame> pictures_{kQueueLength};
  std::optional<render::CameraPath> camera_;  // the making thread computes it; then the drawing thread takes it
  frame::SnapshotPtr before_;                 // making thread: the previous wanted frame
  int made_so_far_ = 0;                       // written by the making thread; read after this thread has ended
  FilmResult result_;
};

}  // namespace

FilmResult make_film(const FilmParts& parts, const FrameRange& made, const FrameRange& wanted,
                     const std::atomic<bool>& stop, Progress& progress, EventLog& log) {
  return Film(parts, made, wanted, stop, progress, log).make();
}

}  // namespace weft::cli
