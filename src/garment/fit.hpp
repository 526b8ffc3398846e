// Fits a pattern to another body: how much wider and taller it must be than the body that the pattern is drawn for.
#pragma once

#include <string>

#include "garment/pattern.hpp"
#include "garment/wearer.hpp"

namespace weft::garment {

/// Measures a body in its pose, with a tape around the trunk and without the arms. The waist is the narrowest section
/// between hips and armpits; hip and chest are the widest sections below and above the waist.
Measures measure(const Wearer& wearer);

/// Factors (x: across, y: up) on the lengths of a pattern. Across: the largest ratio of a girth that both body and
/// pattern have, so that the garment is nowhere tighter than drawn. Up: the ratio of heights; 1 if the pattern has
/// none. If the pattern names only a height, its ratio counts for both. `where` names the scene entry for messages.
/// Throws Error(scene_invalid) if the pattern names no measures.
Vec2 fit_factors(const Pattern& pattern, const Wearer& wearer, const std::string& where);

/// Warning text for a garment that hangs from the waist alone, if the hips of the wearer are too narrow to hold its
/// waist, scaled by `factors`; empty if they hold it.
std::string warn_if_hips_do_not_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer);

}  // namespace weft::garment
