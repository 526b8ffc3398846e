// weft new: a first scene to go on from.
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

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : kEmbeddedTemplates) names.push_back(std::filesystem::path(file.name).stem().string());
  return names;
}

ExitCode make_new(const NewOptions& options) {
  std::filesystem::path scene = options.name;
  if (scene.extension() != ".toml") scene += ".toml";
  // Beside the scene, whose first line names it: editors know all keys from the start.
  const std::filesystem::path schema = scene.parent_path() / "weft.schema.json";
  const std::string schema_text = scene::json_schema() + "\n";
  PathLedger paths;
  paths.writes("NAME", scene);
  const bool has_schema = std::filesystem::exists(schema);
  if (!has_schema) paths.writes("NAME, for the schema,", schema);
  paths.check_absent(options.overwrite);
  paths.check_writable();
  const std::vector<std::string> names = template_names();
  const auto which = std::ranges::find(names, options.kind) - names.begin();
  write_file(scene, kEmbeddedTemplates[static_cast<std::size_t>(which)].text);
  if (!has_schema) write_file(schema, schema_text);
  log::info(fmt::format("{}: written; weft run {} makes a video of it, weft watch {} draws it as it changes",
                        scene.string(), scene.string(), scene.string()));
  return ExitCode::ok;
}

}  // namespace weft::cli
