#include "tools/cli/cached_frames.hpp"

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/log.hpp"

namespace weft::cli {
namespace {

/// Frames that cannot be used.
struct Missing {
  std::vector<int> absent, broken;
  std::string first_problem;  ///< message of the first broken frame

  void check_frame(const cache::Reader& reader, int frame) {
    if (!reader.has(frame)) return absent.push_back(frame);
    try {
      reader.verify(frame);
    } catch (const Error& error) {
      if (broken.empty()) first_problem = error.what();
      broken.push_back(frame);
    }
  }

  bool none() const { return absent.empty() && broken.empty(); }

  std::string text() const {
    const auto frames = [](const std::vector<int>& list) {
      return fmt::format("frame{} {}", list.size() == 1 ? "" : "s", frames_text(list));
    };
    std::string text;
    if (!absent.empty()) text = fmt::format("{} {} missing", frames(absent), absent.size() == 1 ? "is" : "are");
    if (!absent.empty() && !broken.empty()) text += "; ";
    if (!broken.empty()) text += fmt::format("{} cannot be used: {}", frames(broken), first_problem);
    return text;
  }
};

}  // namespace

FrameRange cached_frames(const cache::Reader& reader, const FrameSelection& selection, bool partial) {
  const FrameRange wanted = resolve_frames(selection, reader.manifest().frame_count);
  // Frames before the first missing or broken one.
  FrameRange before{wanted.begin, wanted.begin, wanted.step};
  Missing missing;
  for (int frame = wanted.begin; frame < wanted.end; frame += wanted.step) {
    missing.check_frame(reader, frame);
    if (missing.none()) before.end = frame + 1;
  }
  if (missing.none()) return wanted;
  if (!partial || before.end == wanted.begin)
    throw Error(ExitCode::frames_missing,
                "{}: of frames {} {}; weft simulate --resume simulates the missing frames, --partial uses those before "
                "the first missing one",
                reader.folder().string(), wanted.text(), missing.text());
  log::warn(fmt::format("{}: of frames {} {}; only {} are used", reader.folder().string(), wanted.text(),
                        missing.text(), before.text()));
  return before;
}

void check_frame_before(const cache::Reader& reader, const FrameRange& frames) {
  const int before = frames.begin - frames.step;
  if (before < 0) return;
  Missing missing;
  missing.check_frame(reader, before);
  if (missing.none()) return;
  throw Error(ExitCode::frames_missing,
              "{}: the motion in frame {} needs the frame before it, but {}; weft simulate --resume simulates the "
              "missing frames",
              reader.folder().string(), frames.begin, missing.text());
}

std::string show_frames(const cache::Reader& reader, render::CameraPath& camera) {
  const cache::Reader any(reader.folder(), cache::AcceptedLooks::any);
  std::vector<int> shown;
  for (const int frame : any.frames()) {
    try {
      const cache::CachedFrame cached = any.read(frame);
      if (cached.scene_hash != any.manifest().scene_hash) continue;
      camera.add_frame(*cached.snapshot);
      shown.push_back(frame);
    } catch (const Error& error) {
      if (error.code() != ExitCode::asset_unreadable) throw;
      log::warn(fmt::format("{}; the camera is computed without this frame", error.what()));
    }
  }
  const int all = any.manifest().frame_count;
  if (shown.empty() || static_cast<int>(shown.size()) == all) return "";
  std::string frames = frames_text(shown);
  log::warn(fmt::format("{}: the camera is computed from frames {} of 0:{}; with more frames, it may stand elsewhere",
                        reader.folder().string(), frames, all));
  return frames;
}

}  // namespace weft::cli
