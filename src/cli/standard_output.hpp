// Text output of commands.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace weft::cli {

/// Writes the text at once. If the reader has closed its end, as in `weft man | head`, it returns silently. Throws
/// Error(output_failed) for any other failure.
void write_standard_output(std::string_view text);

template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  write_standard_output(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace weft::cli
