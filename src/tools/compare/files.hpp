// Comparison of two files: pictures, or videos frame by frame.
#pragma once

#include <filesystem>
#include <string>

#include "film/image/png.hpp"
#include "tools/compare/compare.hpp"

namespace weft::compare {

/// Whether the file is a video, by its extension: .mp4, .mov, .mkv, .webm or .avi.
bool is_video(const std::filesystem::path& file);
/// Whether the file is a video whose encoder may have changed the pictures (Decoder::lossy); false
/// if the file cannot be read.
bool is_lossy_video(const std::filesystem::path& file);
/// Whether the file is a picture (.png) or a video, by its extension.
bool is_comparable(const std::filesystem::path& file);
/// Metadata of the heat maps that weft diff writes.
const image::Metadata& heat_map_metadata();
/// Whether the file is a heat map of weft diff, by its metadata; false if it cannot be read. A heat map may lie in a
/// folder of pictures, but is no picture to compare, and no reference.
bool is_heat_map(const std::filesystem::path& file);
/// Limits for two files: those of with_encoder_noise() if either is a lossy video, else `limits`.
Limits limits_for(const Limits& limits, const std::filesystem::path& reference, const std::filesystem::path& test);

struct FileComparison {
  enum class Outcome {
    same,          ///< equal in every pixel
    within,        ///< differs, but not beyond a limit
    differs,       ///< exceeds a limit
    size,          ///< pictures of different sizes: not compared
    frame_count,   ///< videos of different lengths; the common frames are compared
    no_test,       ///< only the reference exists
    no_reference,  ///< only the test exists
    unreadable,
  };
  std::string name;
  std::filesystem::path reference, test;
  Outcome outcome = Outcome::same;
  std::string problem;       ///< what is wrong, for the outcomes from `size` on; else empty
  bool video = false;        ///< whether both files are videos
  int frames = 0;            ///< number of compared frames; a picture counts as one
  int frames_differing = 0;  ///< number of frames that exceed a limit, without spill
  int frames_of_spill = 0;   ///< number of frames that exceed a limit only by spill; see is_spill()
  /// Index, from 0, of the first frame that frames_differing counts; undefined if it counts none.
  int first_differing = 0;
  /// Index, from 0, of the frame with the largest mean FLIP among the frames that exceed a limit
  /// (frames of spill included); among all frames, if none exceeds a limit.
  int worst_frame = 0;
  Comparison worst;  ///< of the worst frame; empty if none was compared
  /// The worst frame as read from both files; empty if none was compared.
  image::Image reference_picture, test_picture;

  bool good() const { return outcome == Outcome::same || outcome == Outcome::within; }
};

/// Compares two existing files. If one of them or the mask cannot be used, or if only one file is a
/// video, the outcome is `unreadable`. `limits`: from limits_for() if the files may be lossy
/// videos. `mask`: a picture file, white where the files are compared and black elsewhere; empty:
/// none.
FileComparison compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                             const Limits& limits, const std::filesystem::path& mask = {});

/// Reads a picture, or the first frame of a video. Throws Error(asset_unreadable).
image::Image first_picture(const std::filesystem::path& file);

}  // namespace weft::compare
