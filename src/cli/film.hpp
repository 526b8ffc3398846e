// The way of a frame: made, kept, drawn, written, told of. Three threads side by side; bounded queues between them keep
// the memory small.
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

/// What a film is put together from. Each is opened in the thread in which it works, lives and dies: an OpenGL context
/// belongs to one. The writer is opened for the first picture, when the painter's description is known.
struct FilmParts {
  std::function<std::unique_ptr<FrameSource>()> open_source;
  std::function<std::unique_ptr<FramePainter>()> open_painter;  ///< empty: nothing is drawn
  std::function<std::unique_ptr<FrameWriter>(const std::string& painter_description)> open_writer;  ///< likewise
  Store* store = nullptr;  ///< keeps what is simulated
  /// One that is found from all frames, where the scene does not place it. Frames that are made are then drawn, from
  /// the store, when the last of them is there.
  std::optional<render::CameraPath> camera = std::nullopt;
  std::filesystem::path meshes;  ///< folder; empty: none
  std::set<int> drawn = {};      ///< wanted frames that an earlier run has drawn
  bool part_is_kept = true;      ///< where the source or the painter fails, what came before is finished
  bool motion = false;           ///< whether the painter wants the frame before, too
  std::function<void(const MadeFrame&)> look = {};  ///< at each frame that is made, in order; may be empty
};

struct FilmResult {
  std::vector<frame::ObjectInfo> objects;
  StageTime setup;                  ///< opening the source
  std::vector<FrameRecord> frames;  ///< all that were made, in order
  int written = 0;
  double cloth_size = 0;         ///< longest side of the box around the largest cloth, in the first frame [m]
  bool interrupted = false;      ///< stopped on request before the last wanted frame
  std::string painter = "none";  ///< its description
  std::exception_ptr failure;    ///< of the stage nearest to the output, if any failed
  bool finished_output = false;  ///< what was written is whole, under its final name
};

/// Goes through the frames that the source makes until the last of `wanted`, or of `made` where the camera has to see
/// them, `stop`, or a failure; `made` has all of `wanted`. Whatever ends it, the frames that were written are finished
/// and kept if the writer itself works. Never throws for a failure of a stage: see `failure`.
FilmResult make_film(const FilmParts& parts, const FrameRange& made, const FrameRange& wanted,
                     const std::atomic<bool>& stop, Progress& progress, EventLog& log);

}  // namespace weft::cli
