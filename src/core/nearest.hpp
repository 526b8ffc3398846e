// "Did you mean": the known name closest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn one text into the other (Damerau, "A
/// technique for computer detection and correction of spelling errors", 1964; no letter edited twice).
int edit_distance(std::string_view from, std::string_view to);

/// The closest of `known`, the first of equally close ones; empty if the number of edits is at least half the length of
/// the longer name.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace weft
