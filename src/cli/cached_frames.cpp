#include "cli/cached_frames.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/log.hpp"

namespace weft::cli {

FrameRange cached_frames(const cache::Reader& reader, FrameSelection selection) {
  const int frame_count = reader.manifest().frame_count;
  const std::vector<int> there = reader.frames();
  int whole = 0;
  while (whole < static_cast<int>(there.size()) && there[whole] == whole) ++whole;
  if (!selection.end && whole < frame_count) {
    log::warn(fmt::format("{} holds {} of {} frames; weft simulate --resume makes the others", reader.folder().string(),
                          whole, frame_count));
    selection.end = std::max(whole, 1);
  }
  const FrameRange wanted = resolve_frames(selection, frame_count);
  for (int frame = wanted.begin; frame < wanted.end; frame += wanted.step) {
    if (std::binary_search(there.begin(), there.end(), frame)) continue;
    throw Error(ExitCode::asset_unreadable, "{}: frame {} is not there; weft simulate --resume makes what is missing",
                reader.folder().string(), frame);
  }
  return wanted;
}

void show_frames(const cache::Reader& reader, render::CameraPath& camera) {
  const cache::Reader any(reader.folder(), cache::Looks::any);
  for (const int frame : any.frames()) {
    const cache::CachedFrame cached = any.read(frame);
    if (cached.scene_hash == any.manifest().scene_hash) camera.see(*cached.snapshot);
  }
}

}  // namespace weft::cli
