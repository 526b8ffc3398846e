// Fits a pattern to a wearer, by ratios of body measures.
#pragma once

#include <string>

#include "film/garment/pattern.hpp"
#include "film/garment/wearer.hpp"

namespace weft::garment {

/// Measures a body in its pose. Girths are those of convex sections of the trunk, without the arms. The waist is the
/// narrowest section between kLowestWaist and kHighestWaist (fit.cpp); hip and chest are the widest sections below and
/// above the waist.
Measures measure(const Wearer& wearer);

/// Factors (x: across, y: up) on the lengths of a pattern. Across: the largest ratio among the girths that the pattern
/// states, so that the garment is nowhere tighter than drawn. Up: the ratio of neck heights, since heads differ more
/// between bodies; 1 if the pattern states no height. If the pattern states only a height, its ratio is used for both.
/// `where` names the scene entry for messages. Throws Error(scene_invalid) if the pattern states no measures.
Vec2 fit_factors(const Pattern& pattern, const Wearer& wearer, const std::string& where);

/// Warning text, or empty. Warns if a pattern has a waist but no chest measure, as skirts and trousers, and the
/// wearer's hips are too narrow to hold the waist of the garment after scaling by `factors`.
std::string warn_if_hips_do_not_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer);

}  // namespace weft::garment
