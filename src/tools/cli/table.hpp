#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft::cli {

/// Formats rows as text with aligned columns, two spaces apart. Each line is indented by `indent` spaces and ends with
/// a line feed. `alignment`: one letter per column, l or r; further columns are left-aligned. Widths count characters,
/// not bytes. Escapes control characters, so that each row is one line.
std::string format_table(std::vector<std::vector<std::string>> rows, std::string_view alignment = "",
                         std::size_t indent = 0);

}  // namespace weft::cli
