// Fits a pattern to a wearer: ratios of the wearer's measures to those of the body that the pattern is drawn for.
#pragma once

#include <string>

#include "film/garment/pattern.hpp"
#include "film/garment/wearer.hpp"

namespace weft::garment {

/// Measures a body in its pose: girths of the convex sections of the trunk, without the arms. The waist is the
/// narrowest section from kLowestWaist to kHighestWaist (fit.cpp); hip and chest are the widest sections below and
/// above the waist.
Measures measure(const Wearer& wearer);

/// Factors (x: across, y: up) on the lengths of a pattern. Across: the largest ratio among the girths that the pattern
/// names, so that the garment is nowhere tighter than drawn. Up: the ratio of the heights of the necks, as heads differ
/// most; 1 if the pattern names no height. If the pattern names only a height, both are this ratio. `where` names the
/// scene entry for messages. Throws Error(scene_invalid) if the pattern names no measures.
Vec2 fit_factors(const Pattern& pattern, const Wearer& wearer, const std::string& where);

/// Warning text for a pattern with a waist but no chest measure, if the wearer's hips are too narrow to hold the waist
/// of the garment, scaled by `factors`; empty if the hips hold it.
std::string warn_if_hips_do_not_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer);

}  // namespace weft::garment
