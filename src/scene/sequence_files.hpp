// The files of a mesh sequence, in order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::scene {

/// All files of a folder, or those whose name fits the one * of a file name; numbers in names count as numbers, so that
/// 10 comes after 9. Empty where there are none.
std::vector<std::filesystem::path> sequence_files(const std::string& files);

}  // namespace weft::scene
