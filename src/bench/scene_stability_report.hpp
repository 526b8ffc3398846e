// The report of scene_stability.hpp, as text and as a picture.
#pragma once

#include <string>

#include "bench/report.hpp"
#include "bench/scene_stability.hpp"

namespace weft::bench {

/// The margin of the scene as it is: one sentence.
std::string margin_sentence(const SceneStability& stability);
/// Where each value breaks below and above its own, and what breaks.
Table margin_table(const SceneStability& stability);
Table trial_table(const SceneStability& stability);
/// A row for each axis, and the map of stiffness and step, coloured by verdict.
std::string trial_svg(const std::string& title, const SceneStability& stability);
std::string scene_stability_markdown(const std::string& title, const SceneStability& stability,
                                     const std::string& picture);

}  // namespace weft::bench
