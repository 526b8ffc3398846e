// The report of scene_stability.hpp, as text and as SVG.
#pragma once

#include <string>

#include "lab/bench/report.hpp"
#include "lab/bench/scene_stability.hpp"

namespace weft::bench {

/// One sentence: the limit nearest to the scene's values, or, if the unchanged scene breaks, the smallest change with
/// which nothing breaks.
std::string margin_sentence(const SceneStability& stability);
/// For each parameter, the first factors below and above 1 at which the scene breaks, and what breaks.
Table margin_table(const SceneStability& stability);
Table trial_table(const SceneStability& stability);
/// One row per parameter, and the map of stiffness and step, coloured by verdict.
std::string trial_svg(const std::string& title, const SceneStability& stability);
std::string scene_stability_markdown(const std::string& title, const SceneStability& stability,
                                     const std::string& picture);

}  // namespace weft::bench
