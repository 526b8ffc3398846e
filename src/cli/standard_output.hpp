// What commands tell on standard output.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace weft::cli {

/// Writes all of it at once. Where the reader has gone, as in `weft man | head`, nobody wants the rest, and nothing is
/// said. Throws Error(output_failed) for what else keeps it from being written.
void write_standard_output(std::string_view text);

template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  write_standard_output(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace weft::cli
