// The pictures of a run: contact sheet, and how they compare with those of its reference.
#pragma once

#include <functional>
#include <vector>

#include "compare/compare.hpp"
#include "image/image.hpp"
#include "review/find_runs.hpp"
#include "review/run_data.hpp"

namespace weft::review {

/// A small picture, evenly spaced from its neighbours.
struct Tile {
  long long picture = 0;  ///< counted from 0
  image::Image image;
};

/// What one pass over the pictures tells.
struct Survey {
  std::vector<Tile> tiles;  ///< all pictures where there are few, else 8 to 15
  long long count = 0;      ///< pictures that could be read
  double fps = 0;           ///< of a video; 0 where the file does not tell, and for stills
  int width = 0, height = 0;
};

/// Throws Error(asset_unreadable) for what cannot be read, also in the middle.
Survey survey(const RunFiles& run);

/// How one picture compares with the one of its reference that shows the same moment.
struct PairComparison {
  long long picture = 0, reference = 0;  ///< counted from 0
  compare::Figures figures;
  compare::Verdict verdict = compare::Verdict::same;
  image::Image heat;  ///< of FLIP; empty where the pictures are the same
};

/// Compares at the pictures `at`, in rising order; those that the reference does not reach are left out. Throws
/// Error(asset_unreadable) for what cannot be read and for pictures of different size.
std::vector<PairComparison> compare_with_reference(const RunFiles& run, const PictureTimes& times,
                                                   const RunFiles& reference, const PictureTimes& reference_times,
                                                   const std::vector<long long>& at);

/// The picture of `to` that shows the moment closest to picture k of `from`.
long long same_moment(long long k, const PictureTimes& from, const PictureTimes& to);

}  // namespace weft::review
