// The data of a run for the page.
#pragma once

#include <string>
#include <vector>

#include "tools/review/find_runs.hpp"

namespace weft::review {

/// The frames of a run's statistics as one array per quantity: {"frame": [0, 1], "max_strain": [0,
/// 0.01]}. Missing values, and values that are neither finite numbers nor booleans, become null.
/// Floating-point numbers keep six significant digits.
Json frame_columns(const Json& frames);

/// Summary of the numbers in each column: {"count", "min", "min_frame", "max", "max_frame", "last", "sum"}. Columns
/// without numbers are omitted.
Json column_digest(const Json& columns);

/// The frames shown by the pictures of a run: picture k shows frame first + k * step, if no picture is missing.
struct PictureTimes {
  long long first = 0, step = 1, count = 0;
  double fps = 0;  ///< pictures per second; 0 if unknown
  std::vector<long long> frames =
      {};  ///< frame of each picture, ascending, if some are missing between others; else empty
};

/// Takes `first`, `count`, `step` (the smallest distance) and `frames` from the names of the numbered pictures. If
/// there are none, takes them from the written frames of the statistics, without those that the metadata of the video
/// exclude. `fps` is the frame rate in the statistics divided by `step`; 0 if there are no statistics.
PictureTimes picture_times(const RunFiles& run);

/// Each value of an effective scene by its path, as in --set: {"cloth.band.material.stretch":
/// "1000000"}. Throws Error(asset_unreadable) if the text is not TOML.
Json scene_values(const std::string& toml, const std::string& file);

/// All data of a run except its pictures. "problems" also names missing pictures, the first gap in the numbers of
/// pictures, and a missing effective scene; missing statistics only if there are pictures and `run.problems` is empty.
/// "columns" and "effective" are large, and the overview of all runs does not need them.
Json run_data(const RunFiles& run);

}  // namespace weft::review
