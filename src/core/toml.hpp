// The one way to TOML from text.
#pragma once

#include <toml++/toml.h>

#include <string_view>

#include "core/nesting.hpp"

namespace weft {

/// Throws toml::parse_error, also for what nests too deep. `source`: that nodes tell as the path of their file.
inline toml::table parse_toml(std::string_view text, std::string_view source = {}) {
  if (nests_too_deep(text))
    throw toml::parse_error("expected at most 128 levels of lists, tables and dotted keys, got more",
                            toml::source_position{1, 1});
  return toml::parse(text, source);
}

}  // namespace weft
