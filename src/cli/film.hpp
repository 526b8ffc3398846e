// The pipeline of a frame: make, store, draw, write, report. Three threads run concurrently; bounded queues between
// them limit memory.
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

#include "cli/event_log.hpp"
#include "cli/frame_range.hpp"
#include "cli/frame_source.hpp"
#include "cli/run_report.hpp"
#include "cli/stages.hpp"
#include "cli/store.hpp"
#include "core/progress.hpp"

namespace weft::cli {

/// The stages of a film. Each stage is opened, used and destroyed in its own thread, since an OpenGL context belongs to
/// one thread. The writer is opened at the first picture, when the painter's description is known.
struct FilmParts {
  std::function<std::unique_ptr<FrameSource>()> open_source;
  std::function<std::unique_ptr<FramePainter>()> open_painter;  ///< empty: nothing is drawn
  std::function<std::unique_ptr<FrameWriter>(const std::string& painter_description)> open_writer;  ///< empty: nothing
                                                                                                    ///< is written
  Store* store = nullptr;  ///< keeps simulated frames
  /// The camera path, to be computed from all frames if the scene does not place the camera. Frames are then drawn from
  /// the store after the last one is made.
  std::optional<render::CameraPath> camera = std::nullopt;
  std::filesystem::path meshes;      ///< folder; empty: none
  std::set<int> drawn = {};          ///< wanted frames that an earlier run has drawn already
  bool keeps_partial_output = true;  ///< if the source or the painter fails, finish and keep the earlier frames
  bool motion = false;               ///< whether the painter also needs the previous frame
  std::function<void(const MadeFrame&)> on_frame = {};  ///< called after each frame is made, in order; may be empty
};

struct FilmResult {
  std::vector<frame::ObjectInfo> objects;
  StageTime setup;                  ///< opening the source
  std::vector<FrameRecord> frames;  ///< all frames that were made, in order
  int written = 0;
  double cloth_size = 0;         ///< longest side of the box around the largest cloth, in the first frame [m]
  bool interrupted = false;      ///< stopped by request before the last wanted frame
  std::string painter = "none";  ///< its description
  std::exception_ptr failure;    ///< of the stage nearest to the output, if any failed
  bool finished_output = false;  ///< the output is complete, under its final name
};

/// Processes the frames of the source until the last of `wanted` (or of `made` if a camera path must be found), `stop`,
/// or a failure. `made` must contain all of `wanted`. In each case, written frames are finished and kept unless the
/// writer itself fails. Does not throw if a stage fails; see `failure`.
FilmResult make_film(const FilmParts& parts, const FrameRange& made, const FrameRange& wanted,
                     const std::atomic<bool>& stop, Progress& progress, EventLog& log);

}  // namespace weft::cli
