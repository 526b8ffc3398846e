// What the page is told about a run.
#pragma once

#include <string>
#include <vector>

#include "review/find_runs.hpp"

namespace weft::review {

/// The frames of a run's statistics as one array per quantity: {"frame": [0, 1], "max_strain": [0, 0.01]}. A frame
/// without a quantity, or with something else than a number or truth value, has null. Six digits are kept.
Json frame_columns(const Json& frames);

/// What the figures of a run need of its columns: for each {"count", "min", "min_frame", "max", "max_frame", "last",
/// "sum"} over what is known; columns without numbers are left out.
Json column_digest(const Json& columns);

/// Which frames the pictures of a run show: the k-th one frame first + k * step.
struct PictureTimes {
  long long first = 0, step = 1, count = 0;
  double fps = 0;  ///< pictures a second; 0 where nothing tells
};

/// As the statistics or the names of the pictures tell.
PictureTimes picture_times(const RunFiles& run);

/// Each value of an effective scene by its path as --set takes it: {"cloth.band.material.stretch": "1000000.0"}. Throws
/// Error(asset_unreadable) for what is no TOML.
Json scene_values(const std::string& toml, const std::string& file);

/// All that the page shows of a run, but for its pictures. What is missing is named in "problems". "columns" and
/// "effective" are large, and only needed where the run itself is looked at.
Json run_data(const RunFiles& run);

}  // namespace weft::review
