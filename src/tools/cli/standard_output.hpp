// Writes text to standard output.
#pragma once

#include <fmt/format.h>

#include <string_view>

#include "core/log.hpp"

namespace weft::cli {

/// Writes and flushes the text. If the reader has closed the pipe, as in `weft man | head`, returns without an error.
/// Throws Error(output_failed) for any other failure.
void write_standard_output(std::string_view text);

/// The same for a formatted text, with control characters escaped.
template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  write_standard_output(log::without_controls(fmt::format(format, std::forward<Args>(args)...)));
}

}  // namespace weft::cli
