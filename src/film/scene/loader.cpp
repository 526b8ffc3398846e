#include "film/scene/loader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/names.hpp"
#include "film/scene/checks.hpp"
#include "film/scene/document.hpp"
#include "film/scene/effective.hpp"
#include "film/scene/findings.hpp"
#include "film/scene/reader.hpp"
#include "film/scene/ropes.hpp"
#include "film/scene/rule.hpp"

namespace weft::scene {

namespace {

using Batches = std::vector<std::vector<std::string>>;  // lists of overrides; see load_batches()

void read_document(toml::table document, const Batches& batches, Scene& scene, Findings& findings) {
  for (std::size_t k = 0; k < batches.size(); ++k)
    for (const std::string& text : batches[k]) apply_override(text, static_cast<int>(k) + 1, document, findings);
  Reader reader(findings, scene.file.parent_path());
  reader.read(document, scene_rules(), &scene, "");
  for (Character& character : scene.characters)
    if (auto* sequence = std::get_if<MeshSequence>(&character.source); sequence && !sequence->files.empty())
      sequence->files =
          std::filesystem::absolute(scene.file.parent_path() / sequence->files).lexically_normal().string();
  add_rope_cloths(scene);
  check(scene, findings);
  const auto set_places = [&](auto& objects, const auto& key_of) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Place place = findings.place_in_file(key_of(i));
      objects[i].line = place.line;
      objects[i].column = place.column;
    }
  };
  set_places(scene.obstacles, [&](std::size_t i) { return findings.entry("obstacle", i) + ".file"; });
  set_places(scene.characters, [&](std::size_t i) { return findings.entry("character", i); });
  set_places(scene.cameras, [&](std::size_t i) { return findings.entry("camera", i); });
  set_places(scene.cloths, [&](std::size_t i) { return entry_of_cloth(scene, i, findings); });
}

/// Loads a scene. `text`: content of the file; nullopt if the file cannot be read (`findings` then contains this
/// mistake).
LoadResult load_from(const std::optional<std::string_view>& text, const std::filesystem::path& file,
                     const Batches& batches, Findings& findings) {
  LoadResult result;
  result.file = file;
  result.text = text.value_or("");
  if (!file.empty()) result.scene.file = std::filesystem::absolute(file);  // absolute("") throws
  result.scene.name = file.stem().string();
  if (!is_plain_name(result.scene.name))
    findings.report("", {},
                    fmt::format("expected a file whose name without its ending can name outputs, got {}; rename it",
                                in_quotes(result.scene.name)));
  if (text) {
    if (auto document = parse(*text, findings)) {
      read_document(std::move(*document), batches, result.scene, findings);
    }
  }
  result.mistakes = findings.take_mistakes();
  if (result.ok()) identify(result.scene);
  return result;
}

// The override as a place in messages: one line of at most 80 bytes.
std::string shorten_override(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return text.size() > 80 ? std::string(beginning_of(text, 77)) + "..." : text;
}

}  // namespace

std::string LoadResult::describe() const {
  std::string lines;
  for (const Mistake& mistake : mistakes) {
    std::string where = file.string();
    if (!mistake.override_text.empty()) {
      where = shorten_override(mistake.override_text);
    } else if (mistake.line > 0) {
      where += fmt::format(":{}:{}", mistake.line, mistake.column);
    }
    lines += where + ": " + (mistake.key.empty() ? "" : mistake.key + ": ") + mistake.text + "\n";
  }
  return lines;
}

LoadResult load(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Findings findings;
  const std::optional<std::string> text = read_file(file, findings);
  return load_from(text ? std::optional<std::string_view>(*text) : std::nullopt, file, {overrides}, findings);
}

LoadResult load_text(std::string_view text, const std::filesystem::path& name,
                     const std::vector<std::string>& overrides) {
  return load_batches(text, name, {overrides});
}

LoadResult load_batches(std::string_view text, const std::filesystem::path& name, const Batches& batches) {
  Findings findings;
  return load_from(text, name, batches, findings);
}

}  // namespace weft::scene
