// How deep TOML and JSON nest, found out before any parser or destructor recurses into them.
#pragma once

#include <string_view>

namespace weft {

/// Levels that a document may nest: lists, tables, and the parts of a dotted key. No scene has more than ten; a level
/// takes less than 1 kB of a stack of 8 MB.
inline constexpr int kMaxDepth = 128;

/// Whether TOML or JSON text nests deeper than kMaxDepth. Text that is neither may be called deep or not: its parser
/// stops at the first mistake, before which this function counts at least as many levels as the parser makes.
bool nests_too_deep(std::string_view text);

}  // namespace weft
