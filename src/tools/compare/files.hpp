// Comparison of two files: pictures, or videos frame by frame.
#pragma once

#include <filesystem>
#include <string>

#include "tools/compare/compare.hpp"

namespace weft::compare {

/// Whether the file is a video, by its extension: .mp4, .mov, .mkv, .webm or .avi.
bool is_video(const std::filesystem::path& file);
/// Whether the file is a video whose encoder has changed the pictures; false if it cannot be read.
bool is_lossy_video(const std::filesystem::path& file);
bool is_comparable(const std::filesystem::path& file);
/// Limits for two files: if either is a lossy video, default limits are wider; see with_encoder_noise().
Limits limits_for(const Limits& limits, const std::filesystem::path& reference, const std::filesystem::path& test);

struct FileComparison {
  enum class Outcome {
    same,          ///< equal in every pixel
    within,        ///< differs, within the limits
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
  std::string problem;       ///< description, for the outcomes `size` and later ones
  bool video = false;        ///< else a picture, which counts as one frame
  int frames = 0;            ///< number of compared frames
  int frames_differing = 0;  ///< frames that exceed a limit; spill does not count
  int frames_of_spill = 0;   ///< frames of a lossy video that differ by spill; see is_spill()
  int first_differing = 0;   ///< index of the first differing frame, from 0; undefined if there is none
  int worst_frame = 0;       ///< from 0: largest mean FLIP of the frames that exceed a limit, else of all
  Comparison worst;          ///< of the worst frame; empty if none was compared
  /// The worst frame as read from both files; empty if none was compared.
  image::Image reference_picture, test_picture;

  bool good() const { return outcome == Outcome::same || outcome == Outcome::within; }
};

/// Compares two existing files; a defect of one of them or of the mask is stored in the result. `limits` apply as they
/// are; see limits_for(). `mask`: file of a picture that is white where the files are compared and black elsewhere; may
/// be empty.
FileComparison compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                             const Limits& limits, const std::filesystem::path& mask = {});

/// The picture, or the first frame of a video. Throws Error(asset_unreadable).
image::Image first_picture(const std::filesystem::path& file);

}  // namespace weft::compare
