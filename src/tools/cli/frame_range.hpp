// `--frames A:B:STEP`: which frames of a scene are drawn.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::cli {

/// The half-open range as the user typed it. No `begin`: from frame 0. No `end`: to the end of the scene.
struct FrameSelection {
  std::optional<int> begin, end;
  int step = 1;

  bool selects_all() const { return !begin && !end && step == 1; }
};

/// Frames begin, begin + step, ... below end. Never empty.
struct FrameRange {
  int begin = 0, end = 1, step = 1;

  bool contains(int frame) const { return frame >= begin && frame < end && (frame - begin) % step == 0; }
  int count() const { return (end - begin + step - 1) / step; }
  int last() const { return begin + (count() - 1) * step; }
  std::string text() const;
};

/// Text of `frames` (ascending, at least one), such as `3, 8:21`: consecutive frames become a half-open range.
std::string frames_text(const std::vector<int>& frames);

/// Parses `A:B`, `A:B:STEP`, `A:`, `:B` or `:`. Throws Error(usage).
FrameSelection parse_frames(std::string_view text);

/// The selected frames of a scene with `frame_count` frames. Throws Error(usage) if the selection is empty or ends
/// after the scene.
FrameRange resolve_frames(const FrameSelection& selection, int frame_count);

}  // namespace weft::cli
