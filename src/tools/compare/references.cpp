#include "tools/compare/references.hpp"

#include <algorithm>
#include <regex>
#include <set>
#include <system_error>

#include "core/error.hpp"
#include "film/image/png.hpp"
#include "film/video/decoder.hpp"
#include "tools/compare/files.hpp"

namespace weft::compare {
namespace {

namespace fs = std::filesystem;

// Folders that may contain references, the most specific one first.
std::vector<fs::path> places(const fs::path& folder, const std::string& machine) {
  std::vector<fs::path> found = {folder / "default", folder};
  if (!machine.empty()) found.insert(found.begin(), folder / machine);
  return found;
}

// Whether the first folder of the name is that of a machine class or `default`.
bool is_of_class(const std::string& name) {
  static const std::regex kClass(R"((default|mesa-\d+\.\d+(-\d+bit)?)/.*)");
  return std::regex_match(name, kClass);
}

}  // namespace

std::string machine_class(const std::string& gl) {
  std::smatch mesa, bits;
  if (!std::regex_search(gl, mesa, std::regex(R"(Mesa (\d+\.\d+))"))) return "";
  const bool wide = std::regex_search(gl, bits, std::regex(R"((\d+) bits)"));
  return "mesa-" + mesa[1].str() + (wide ? "-" + bits[1].str() + "bit" : "");
}

std::string machine_class_of(const fs::path& file) {
  try {
    image::Metadata metadata = is_video(file) ? video::Decoder(file).metadata() : image::read_png_metadata(file);
    return machine_class(metadata["gl"]);
  } catch (const Error&) {
    return "";  // the comparison of the file reports the reason
  }
}

std::string machine_class_of(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::string machine = machine_class_of(folder / name); !machine.empty()) return machine;
  return "";
}

std::optional<fs::path> find_reference(const fs::path& folder, const std::string& name, const std::string& machine) {
  for (const fs::path& place : places(folder, machine)) {
    if (fs::is_regular_file(place / name) && !is_heat_map(place / name)) return place / name;
  }
  return std::nullopt;
}

std::vector<std::string> reference_names(const fs::path& folder, const std::string& machine) {
  std::set<std::string> names;
  for (const fs::path& place : places(folder, machine)) {
    if (!fs::is_directory(place)) continue;
    for (const std::string& name : comparable_names(place))
      if (place != folder || !is_of_class(name)) names.insert(name);
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> comparable_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  // Follows links to folders; a cycle of links causes an error.
  fs::recursive_directory_iterator entry(folder, fs::directory_options::follow_directory_symlink, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    // Skips hidden files: Weft writes to a hidden file, and renames the file when it is complete.
    const bool hidden = entry->path().filename().string().starts_with('.');
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      if (hidden) entry.disable_recursion_pending();
    } else if (!hidden && entry->is_regular_file(ignored) && is_comparable(entry->path()) &&
               !is_heat_map(entry->path())) {
      names.push_back(entry->path().lexically_relative(folder).generic_string());
    }
  }
  if (error) throw Error(ExitCode::asset_unreadable, "{}: {}", folder.string(), error.message());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace weft::compare
