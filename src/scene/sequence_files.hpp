// The files of a mesh sequence, in order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::scene {

/// All files of a folder, or those that match a file name with one *. Numbers in names are compared by value, so that
/// 10 follows 9. Returns nothing if no file matches.
std::vector<std::filesystem::path> sequence_files(const std::string& files);

}  // namespace weft::scene
