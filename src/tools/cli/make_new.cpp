// weft new: writes a template scene, or a repository of scenes.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "core/input_file.hpp"
#include "core/log.hpp"
#include "core/names.hpp"
#include "core/temporary_file.hpp"
#include "embedded_templates.hpp"
#include "film/scene/loader.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/option_values.hpp"
#include "tools/cli/path_ledger.hpp"

namespace weft::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestIgnoreFile = 1 << 20;  // [bytes]

// Name of the template to which a file belongs: the first folder of its path or, without a folder, its name without
// extension.
std::string template_of(const EmbeddedFile& file) {
  return (*fs::path(file.name).begin()).stem().string();
}

// Whether the name is in use; that of a symbolic link is, even if its target does not exist.
bool is_taken(const fs::path& file) {
  return fs::exists(fs::symlink_status(file));
}

// Changes that add a template of several files to a folder without replacing a file. An existing .gitignore gets the
// missing lines; if a README.md exists, the new one is named PICTURES.md; other existing files stay.
struct Added {
  std::vector<std::pair<fs::path, std::string>> files;  // paths and contents
  std::vector<std::string> kept;                        // existing files that stay
  fs::path readme;                                      // the file that explains the next steps
};

std::string with_missing_lines(const std::string& text, const std::string& wanted) {
  std::set<std::string> present;
  std::string line, result = text;
  for (std::istringstream lines(text); std::getline(lines, line);) present.insert(line);
  if (!result.empty() && result.back() != '\n') result += '\n';
  for (std::istringstream lines(wanted); std::getline(lines, line);)
    if (!present.contains(line)) result += line + "\n";
  return result;
}

Added add_to_folder(const std::vector<std::pair<fs::path, std::string>>& files) {
  Added added;
  for (const auto& [file, text] : files) {
    const bool is_readme = file.filename() == "README.md";
    if (is_readme) added.readme = file;
    if (!is_taken(file)) {
      added.files.emplace_back(file, text);
    } else if (file.filename() == ".gitignore" && fs::is_regular_file(file)) {
      const std::string before = read_file(file, kLargestIgnoreFile);
      const std::string after = with_missing_lines(before, text);
      if (after != before) added.files.emplace_back(file, after);
    } else if (is_readme) {
      added.readme = file.parent_path() / "PICTURES.md";
      if (is_taken(added.readme))
        added.kept.push_back(added.readme.string());
      else
        added.files.emplace_back(added.readme, text);
    } else {
      added.kept.push_back(file.string());
    }
  }
  return added;
}

}  // namespace

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : kEmbeddedTemplates) names.push_back(template_of(file));
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

ExitCode make_new(const NewOptions& options) {
  // Writes the schema beside the scene. The first line of the scene names the schema, with which editors complete and
  // check keys.
  std::vector<std::pair<fs::path, std::string>> files;
  fs::path scene = options.name;
  bool is_folder = false;
  for (const EmbeddedFile& file : kEmbeddedTemplates) {
    if (template_of(file) != options.kind) continue;
    is_folder = fs::path(file.name).has_parent_path();
    if (!is_folder && !is_plain_name(scene.filename().string()))
      throw Error(ExitCode::usage, "NAME: expected the name of a scene, such as dress or scenes/dress, got {}",
                  options.name);
    if (!is_folder && scene.extension() != ".toml") scene += ".toml";
    files.emplace_back(is_folder ? scene / fs::path(file.name).lexically_relative(options.kind) : scene, file.text);
  }
  const fs::path schema = (is_folder ? scene : scene.parent_path()) / "weft.schema.json";
  if (options.overwrite || !is_taken(schema)) files.emplace_back(schema, scene::json_schema());
  PathLedger paths;
  for (const auto& [file, text] : files) paths.writes("NAME", file);
  const std::string name = scene.string();
  if (is_folder && !options.overwrite) {
    const Added added = add_to_folder(files);
    paths.check_writable();
    for (const auto& [file, text] : added.files) write_file(file, text);
    for (const std::string& kept : added.kept) log::info(fmt::format("{}: kept as it is", kept));
    log::info(fmt::format("{}: {} files written; {} explains the next steps", name, added.files.size(),
                          added.readme.string()));
    return ExitCode::ok;
  }
  paths.check_absent(options.overwrite);
  paths.check_writable();
  for (const auto& [file, text] : files) write_file(file, text);
  log::info(is_folder
                ? fmt::format("{}: written; {} explains the next steps", name, (scene / "README.md").string())
                : fmt::format("{}: written; weft run {} makes a video of it, weft watch {} draws it as it changes",
                              name, name, name));
  return ExitCode::ok;
}

}  // namespace weft::cli
