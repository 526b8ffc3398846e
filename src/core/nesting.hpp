// Nesting depth of TOML and JSON, checked before any parser or destructor recurses.
#pragma once

#include <string_view>

namespace weft {

/// Maximum nesting depth of a document: lists, tables, and the components of a dotted key. No scene has more than ten.
/// Each level takes less than 1 kB of a stack of 8 MB.
inline constexpr int kMaxDepth = 128;

/// Whether TOML or JSON text nests deeper than kMaxDepth. Up to the first mistake of a text, where the parser stops,
/// this function counts at least as many levels as the parser creates; behind it the result is arbitrary.
bool nests_too_deep(std::string_view text);

}  // namespace weft
