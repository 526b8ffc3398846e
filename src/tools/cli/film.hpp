// The pipeline of a film. Three threads run concurrently: one makes frames (simulates or reads them) and stores them;
// one draws them; the calling thread writes and reports them. Bounded queues between the threads limit memory.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/frame_range.hpp"
#include "tools/cli/frame_source.hpp"
#include "tools/cli/run_report.hpp"
#include "tools/cli/stages.hpp"
#include "tools/cli/store.hpp"

namespace weft::cli {

/// What make_film() combines. Each stage is opened, used and destroyed in its own thread, since an OpenGL context
/// belongs to one thread. The writer is opened at the first picture, when the painter's description is known.
struct FilmParts {
  std::function<std::unique_ptr<FrameSource>()> open_source;
  std::function<std::unique_ptr<FramePainter>()> open_painter;  ///< empty: nothing is drawn
  std::function<std::unique_ptr<FrameWriter>(const std::string& painter_description)> open_writer;  ///< empty: nothing
                                                                                                    ///< is written
  Store* store = nullptr;  ///< keeps simulated frames
  /// Set if the camera path must be computed from all frames. Drawing then waits until the last frame is made, and the
  /// frames to draw come from the store.
  std::optional<render::CameraPath> camera = std::nullopt;
  std::filesystem::path meshes;      ///< folder for meshes; empty: none are written
  std::set<int> drawn = {};          ///< wanted frames that an earlier run has drawn already; they are not drawn again
  bool keeps_partial_output = true;  ///< if source or painter fails, finish the output with the earlier frames
  bool motion = false;  ///< whether the painter also gets the previous wanted frame, for motion blur or layers
  std::function<void(const MadeFrame&)> on_frame = {};  ///< called after each frame is made, in order; may be empty
};

struct FilmResult {
  std::vector<frame::ObjectInfo> objects;
  StageTime setup;                  ///< time for opening the source
  std::vector<FrameRecord> frames;  ///< all frames that were made, in order
  /// Number of frames that all stages have completed.
  int written = 0;
  /// Longest side of the bounding box of the largest cloth or rope in the first frame [m]; 0: none.
  double cloth_size = 0;
  bool interrupted = false;      ///< `stop` became true before the last frame was made or drawn
  std::string painter = "none";  ///< description of the painter
  /// Exception of the failed stage; null if none failed. If several stages failed, the exception of
  /// the last of them in the pipeline.
  std::exception_ptr failure;
  bool finished_output = false;  ///< the output has its final name; it may have fewer frames than wanted
};

/// Makes the frames `made`; draws and writes the frames `wanted`, a subset of them. Ends after the last frame of
/// `wanted`, or of `made` if the camera path is computed from these frames; earlier if `stop` becomes true or a stage
/// fails. Then finishes the output with the frames written so far, unless the writer failed, or another stage failed
/// and `keeps_partial_output` is false. Does not throw if a stage fails; see FilmResult::failure.
FilmResult make_film(const FilmParts& parts, const FrameRange& made, const FrameRange& wanted,
                     const std::atomic<bool>& stop, Progress& progress, EventLog& log);

}  // namespace weft::cli
