// The files of a mesh sequence, in order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::scene {

/// `files`: a folder, or a path whose file name contains one *. Returns all files of the folder, or all files that
/// match the name; empty if there are none. The files are sorted by name, with numbers compared by value: 10 follows 9.
std::vector<std::filesystem::path> sequence_files(const std::string& files);

}  // namespace weft::scene
