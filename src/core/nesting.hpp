// Limits the nesting depth of TOML and JSON before a recursive parser or destructor could overflow the stack.
#pragma once

#include <string_view>

namespace weft {

/// Maximum nesting depth. In JSON, it applies to the whole text; in TOML, to each header, and to each key with its
/// value. Lists, tables and components of a dotted key count as levels. No shipped scene has more than ten levels. A
/// parser needs less than 1 kB of stack per level, and the stack usually has 8 MB.
inline constexpr int kMaxDepth = 128;

/// Whether TOML or JSON text nests deeper than kMaxDepth. After a syntax error the count may be wrong, which does no
/// harm, because the parser stops at the error. If the result is false, a TOML document nests at most about
/// 3 kMaxDepth levels: a key is counted without the header above it, and each component of a header may be a list of
/// tables, which has two levels.
bool nests_too_deep(std::string_view text);

}  // namespace weft
