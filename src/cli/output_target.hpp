// Where the pictures go: one video, one PNG file per frame, or nowhere.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "cli/frame_range.hpp"

namespace weft::cli {

/// A file name with a place for the frame number: `{frame}`, or `{frame:05}` for five digits.
class FramePattern {
 public:
  /// Throws Error(usage) if the text has no such place, several, or other braces.
  explicit FramePattern(std::string_view text);

  std::filesystem::path name(int frame) const;

 private:
  std::string before_, after_;
  int digits_ = 1;
};

struct OutputTarget {
  enum class Kind { video, images, none };
  Kind kind = Kind::video;
  std::string text;  ///< as the user typed it, or the default; a pattern where kind is images

  /// The file of one frame (images) or of all of them (video).
  std::filesystem::path file(int frame) const;
};

/// Understands `-o`; empty: `output/<scene>.mp4`. Throws Error(usage) for endings that cannot be written.
OutputTarget parse_output(const std::string& text, const std::string& scene_name);

/// Opens a temporary file beside `file` for a moment: permissions alone do not tell (read-only mounts, root, quotas).
/// Makes missing folders. Throws Error(output_failed) with the system's reason.
void check_writable(const std::filesystem::path& file);

/// Throws Error(output_failed) if `file` exists and `overwrite` is not set, or if it is a folder.
void check_absent(const std::filesystem::path& file, bool overwrite);

/// Removes from `folder` what a killed process has left of files with these names under their temporary ones. The
/// caller has made sure that no other process writes them.
void remove_half_files(const std::filesystem::path& folder, const std::set<std::string>& names);

/// Both checks for the files of the target.
void prepare_output(const OutputTarget& target, const FrameRange& frames, bool overwrite);

}  // namespace weft::cli
