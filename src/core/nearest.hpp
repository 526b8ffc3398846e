// "Did you mean": the known name closest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft {

/// Minimum number of insertions, deletions, replacements and swaps of neighbours that turn one text into the other
/// (Damerau, "A technique for computer detection and correction of spelling errors", 1964), editing no letter twice.
int edit_distance(std::string_view from, std::string_view to);

/// The name of `known` with the smallest edit distance from `name`; the first of several. Empty if this distance is at
/// least half the length of the longer of both names.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace weft
