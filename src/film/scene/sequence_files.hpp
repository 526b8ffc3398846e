// The files of a mesh sequence, in order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::scene {

/// `files`: a folder, of which all files are returned, or a file name with one *, for all files that match. Numbers in
/// names are compared by value, so that 10 follows 9. Returns an empty list if no file matches.
std::vector<std::filesystem::path> sequence_files(const std::string& files);

}  // namespace weft::scene
