// The report about the stability margins of a scene, as text and as SVG.
#pragma once

#include <string>

#include "lab/bench/report.hpp"
#include "lab/bench/scene_stability.hpp"

namespace weft::bench {

/// One sentence: the margin nearest to the scene's values; but if the unchanged scene breaks, the smallest change with
/// which the scene has no fault.
std::string margin_sentence(const SceneStability& stability);
/// For each parameter, the factors below and above 1 at which the scene first breaks, and the faults there.
Table margin_table(const SceneStability& stability);
Table trial_table(const SceneStability& stability);
/// One row of trials per parameter, and the map of stiffness and step, coloured by verdict.
std::string trial_svg(const std::string& title, const SceneStability& stability);
std::string scene_stability_markdown(const std::string& title, const SceneStability& stability,
                                     const std::string& picture);

}  // namespace weft::bench
