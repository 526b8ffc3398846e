// weft new: a first scene to go on from, or a repository of scenes.
#include <fmt/format.h>

#include <algorithm>

#include "cli/commands.hpp"
#include "cli/option_values.hpp"
#include "cli/path_ledger.hpp"
#include "core/log.hpp"
#include "core/temporary_file.hpp"
#include "embedded_templates.hpp"
#include "scene/loader.hpp"

namespace weft::cli {

namespace {

namespace fs = std::filesystem;

// A file, or a folder of files with all below it.
std::string template_of(const EmbeddedFile& file) {
  return (*fs::path(file.name).begin()).stem().string();
}

}  // namespace

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : kEmbeddedTemplates) names.push_back(template_of(file));
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

ExitCode make_new(const NewOptions& options) {
  // Editors know all keys from the start: the first line of a scene names its schema.
  std::vector<std::pair<fs::path, std::string>> files;
  fs::path scene = options.name;
  bool is_folder = false;
  for (const EmbeddedFile& file : kEmbeddedTemplates) {
    if (template_of(file) != options.kind) continue;
    is_folder = fs::path(file.name).has_parent_path();
    if (!is_folder && scene.extension() != ".toml") scene += ".toml";
    files.emplace_back(is_folder ? scene / fs::path(file.name).lexically_relative(options.kind) : scene, file.text);
  }
  const fs::path schema = (is_folder ? scene : scene.parent_path()) / "weft.schema.json";
  if (!fs::exists(schema)) files.emplace_back(schema, scene::json_schema() + "\n");
  PathLedger paths;
  for (const auto& [file, text] : files) paths.writes("NAME", file);
  paths.check_absent(options.overwrite);
  paths.check_writable();
  for (const auto& [file, text] : files) write_file(file, text);
  const std::string name = scene.string();
  log::info(is_folder
                ? fmt::format("{}: written; {} says how to go on", name, (scene / "README.md").string())
                : fmt::format("{}: written; weft run {} makes a video of it, weft watch {} draws it as it changes",
                              name, name, name));
  return ExitCode::ok;
}

}  // namespace weft::cli
