#include "film/scene/sequence_files.hpp"

#include <algorithm>
#include <system_error>

namespace weft::scene {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A sort key that orders names by the numbers in them. In the key, numbers have no leading zeros, and a character
/// before each number stands for the count of its digits.
std::string sort_key(const std::string& name) {
  std::string key;
  for (std::size_t i = 0; i < name.size();) {
    if (!is_digit(name[i])) {
      key += name[i++];
      continue;
    }
    while (i + 1 < name.size() && name[i] == '0' && is_digit(name[i + 1])) ++i;
    std::size_t end = i;
    while (end < name.size() && is_digit(name[end])) ++end;
    key += static_cast<char>('0' + std::min<std::size_t>(end - i, 60));
    key.append(name, i, end - i);
    i = end;
  }
  return key;
}

}  // namespace

std::vector<std::filesystem::path> sequence_files(const std::string& files) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool folder = fs::is_directory(files, error);
  const std::string name = fs::path(files).filename().string();
  const std::size_t star = name.find('*');
  if (!folder && star == std::string::npos) return {};
  const std::string head = folder ? "" : name.substr(0, star), tail = folder ? "" : name.substr(star + 1);
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder ? fs::path(files) : fs::path(files).parent_path(), error)) {
    const std::string each = entry.path().filename().string();
    const bool fits = each.size() >= head.size() + tail.size() && each.starts_with(head) && each.ends_with(tail);
    if (fits && entry.is_regular_file(error)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) {
    const std::string left = a.filename().string(), right = b.filename().string();
    return std::pair(sort_key(left), left) < std::pair(sort_key(right), right);
  });
  return found;
}

}  // namespace weft::scene
