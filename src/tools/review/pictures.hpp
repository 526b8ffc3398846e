// The pictures of a run: contact sheet, and comparison with its reference.
#pragma once

#include <functional>
#include <vector>

#include "film/image/image.hpp"
#include "tools/compare/compare.hpp"
#include "tools/review/find_runs.hpp"
#include "tools/review/run_data.hpp"

namespace weft::review {

/// A small picture of the contact sheet.
struct Tile {
  long long picture = 0;  ///< index, from 0
  image::Image image;
};

/// Result of one pass over the pictures of a run.
struct PictureSummary {
  std::vector<Tile> tiles;    ///< evenly spaced: all pictures if there are fewer than 16, else 8 to 15
  long long count = 0;        ///< number of pictures
  double fps = 0;             ///< frame rate of a video [1/s]; 0 if the file does not state it, and for stills
  int width = 0, height = 0;  ///< of the first picture [pixels]; 0 if there is none
};

/// Reads all pictures of a run. Throws Error(asset_unreadable) if any picture cannot be read.
PictureSummary read_pictures(const RunFiles& run);

/// Comparison of a picture of a run with the picture of its reference at the same time.
struct PairComparison {
  long long picture = 0, reference = 0;  ///< indices, from 0
  compare::Figures figures;
  compare::Verdict verdict = compare::Verdict::same;
  image::Image heat;  ///< FLIP map in colours, at most 640 pixels wide; empty if the pictures are equal
};

/// Compares pictures of a run with the pictures of its reference at the same times. `at`: indices
/// of the pictures of the run, ascending. Skips a picture if the reference has no picture at its
/// time, or if that picture of the reference was already compared. Throws Error(asset_unreadable)
/// if pictures cannot be read or differ in size.
std::vector<PairComparison> compare_with_reference(const RunFiles& run, const PictureTimes& times,
                                                   const RunFiles& reference, const PictureTimes& reference_times,
                                                   const std::vector<long long>& at);

/// Index of the picture of `to` that is closest in time to picture k of `from`; the index may be negative or beyond the
/// last picture of `to`. Returns k if either frame rate is unknown. If pictures are missing (PictureTimes::frames),
/// counts them; returns -1 if the picture of `to` is missing.
long long index_at_same_time(long long k, const PictureTimes& from, const PictureTimes& to);

}  // namespace weft::review
