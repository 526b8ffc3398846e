// Two files compared: pictures, or videos frame by frame.
#pragma once

#include <filesystem>
#include <string>

#include "compare/compare.hpp"

namespace weft::compare {

/// By its ending: .png, or one of .mp4 .mov .mkv .webm .avi.
bool is_video(const std::filesystem::path& file);
/// Whether it is a video whose encoder has changed its pictures; false for what cannot be read.
bool is_lossy_video(const std::filesystem::path& file);
bool is_comparable(const std::filesystem::path& file);

struct FileComparison {
  enum class Outcome {
    same,          ///< equal in every pixel
    within,        ///< differs, within the limits
    differs,       ///< past a limit
    size,          ///< pictures of different size: not compared
    frame_count,   ///< videos of different length; the frames that both have are compared
    no_test,       ///< only the reference is there
    no_reference,  ///< only the test is there
    unreadable,
  };
  std::string name;
  std::filesystem::path reference, test;
  Outcome outcome = Outcome::same;
  std::string problem;       ///< in words, for the outcomes from `size` on
  bool video = false;        ///< else a picture, of one frame
  int frames = 0;            ///< that were compared
  int frames_differing = 0;  ///< of these, those past a limit, spill apart
  int frames_of_spill = 0;   ///< of a lossy video, beside those: an encoder predicted them from a changed one
  int first_differing = 0;   ///< the first of them, counted from 0; of no meaning where there is none
  int worst_frame = 0;       ///< from 0; past a limit before within it, then with the largest mean of the FLIP map
  Comparison worst;          ///< of that frame; empty if none was compared
  /// Of that frame as they were read; empty if none was compared.
  image::Image reference_picture, test_picture;

  bool good() const { return outcome == Outcome::same || outcome == Outcome::within; }
};

/// Both files exist; a problem of one of them, or of the mask, is in the result. `mask`: a picture that is white where
/// they are compared and black elsewhere; may be empty.
FileComparison compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                             const Limits& limits, const std::filesystem::path& mask = {});

/// The picture, or the first of the video. Throws Error(asset_unreadable).
image::Image first_picture(const std::filesystem::path& file);

}  // namespace weft::compare
