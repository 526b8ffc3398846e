// What differs between the runs that two pictures come from.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// What of scene and program differs, as pictures or videos say of themselves, and as the effective scenes beside them
/// say. Empty if it is not known.
std::string describe_origin_changes(const std::filesystem::path& reference, const std::filesystem::path& test);

}  // namespace weft::cli
