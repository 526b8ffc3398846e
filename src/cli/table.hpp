#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft::cli {

/// Lines of text with aligned columns, two spaces apart, each line indented by `indent` spaces and ended by a line
/// feed. One letter of `alignment` per column: l or r; columns past its end are left-aligned. Widths count characters,
/// not bytes.
std::string format_table(const std::vector<std::vector<std::string>>& rows, std::string_view alignment = "",
                         std::size_t indent = 0);

}  // namespace weft::cli
