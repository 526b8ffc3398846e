#include "film/scene/effective.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <span>

#include "film/scene/dependencies.hpp"
#include "film/scene/loader.hpp"
#include "film/scene/ropes.hpp"
#include "film/scene/rule.hpp"

namespace weft::scene {

namespace {

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (byte < 0x20 || byte == 0x7F) {
      out += fmt::format("\\u{:04X}", byte);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// A value as TOML text. fmt writes numbers with the fewest digits that give the same double when they are read.
std::string toml_value(const Value& value, const Rule& rule) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return toml_string(*text);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
    std::vector<std::string> quoted;
    for (const std::string& text : *texts) quoted.push_back(toml_string(text));
    return fmt::format("[{}]", fmt::join(quoted, ", "));
  }
  const auto& numbers = std::get<std::vector<double>>(value);
  if (rule.type == Type::points) {
    std::vector<std::string> points;
    const std::size_t size = rule.components.size();
    for (std::size_t i = 0; i < numbers.size(); i += size)
      points.push_back(fmt::format("[{}]", fmt::join(std::span(numbers).subspan(i, size), ", ")));
    return fmt::format("[{}]", fmt::join(points, ", "));
  }
  return rule.components.empty() ? fmt::format("{}", numbers[0]) : fmt::format("[{}]", fmt::join(numbers, ", "));
}

/// Which keys are written: all, or only those that affect the simulation.
enum class KeySelection { all, simulated };

/// Writes the effective scene as TOML.
class Writer {
 public:
  explicit Writer(KeySelection selection) : selection_(selection) {}

  std::string text;

  /// Writes a table: first its own keys, then its inner tables and lists. `path`: key path of the table; empty for the
  /// root table.
  void write(const Table& table, void* target, const std::string& path) {
    for_rules(table, target, [&](const Rule& rule) { write_value(rule, target); });
    for_rules(table, target, [&](const Rule& rule) {
      const std::string inner = path.empty() ? rule.key : path + "." + rule.key;
      if (rule.type == Type::table) {
        if (rule.count && rule.count(target) == 0) return;
        text += fmt::format("\n[{}]\n", inner);
        write(*rule.table, rule.inner(target), inner);
      } else if (rule.type == Type::list) {
        for (std::size_t i = 0; i < rule.count(target); ++i) {
          text += fmt::format("\n[[{}]]\n", inner);
          write(*rule.table, rule.entry(target, i), inner);
        }
      }
    });
  }

 private:
  template <class Body>
  void for_rules(const Table& table, void* target, const Body& body) const {
    const auto visit = [&](const std::vector<Rule>& rules) {
      for (const Rule& rule : rules)
        if (selection_ == KeySelection::all || rule.simulated) body(rule);
    };
    visit(table.rules);
    if (const Variant* variant = table.variant_of(target)) visit(variant->rules);
  }

  void write_value(const Rule& rule, void* target) {
    if (rule.type == Type::keys) {
      write_keys(rule, target);
    } else if (rule.get) {
      const Value value = rule.get(target);
      const auto* string = std::get_if<std::string>(&value);
      const bool absent = std::holds_alternative<std::monostate>(value) || (string != nullptr && string->empty());
      if (!absent) text += fmt::format("{} = {}\n", rule.key, toml_value(value, rule));
    }
  }

  void write_keys(const Rule& rule, void* target) {
    const std::size_t count = rule.count(target);
    if (count == 0) return;
    text += rule.key + " = [\n";
    for (std::size_t i = 0; i < count; ++i) {
      std::string members;
      for (const Rule& member : rule.table->rules) {
        const Value value = member.get(rule.entry(target, i));
        if (std::holds_alternative<std::monostate>(value)) continue;
        members += fmt::format("{}{} = {}", members.empty() ? "" : ", ", member.key, toml_value(value, member));
      }
      text += fmt::format("  {{ {} }},\n", members);
    }
    text += "]\n";
  }

  const KeySelection selection_;
};

std::string text_of(const Scene& scene, KeySelection selection) {
  // Rules access members through non-const pointers, so work on a copy.
  Scene copy = scene;
  remove_rope_cloths(copy);
  Writer writer(selection);
  writer.write(scene_rules(), &copy, "");
  return std::move(writer.text);
}

/// The hash function FNV-1a with 64 bits (Fowler, Noll and Vo).
class Fnv1a {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

/// Removes the folders from file names, because hashes must not depend on folders.
void keep_file_names(Scene& scene) {
  const auto keep_name = [](std::filesystem::path& path) { path = path.filename(); };
  const auto keep_name_if_any = [&](std::optional<std::filesystem::path>& path) {
    if (path) keep_name(*path);
  };
  const auto keep_names_of_pictures = [&](Look& look) {
    keep_name_if_any(look.image);
    for (PanelPaint& panel : look.panels) keep_name_if_any(panel.image);
  };
  for (Obstacle& obstacle : scene.obstacles) {
    if (auto* mesh = std::get_if<MeshFile>(&obstacle.shape)) keep_name(mesh->path);
    keep_names_of_pictures(obstacle.look);
  }
  for (Cloth& cloth : scene.cloths) {
    keep_name(cloth.file);
    for (Pin& pin : cloth.pins) keep_name_if_any(pin.mask);
    for (Weight& weight : cloth.weights) keep_name_if_any(weight.mask);
    keep_names_of_pictures(cloth.look);
  }
  for (Attachment& attachment : scene.attachments) keep_name_if_any(attachment.mask);
  for (Character& character : scene.characters) {
    if (auto* file = std::get_if<CharacterFile>(&character.source)) keep_name(file->path);
    if (SkeletonMotion* skeleton_motion = skeleton_motion_of(character)) keep_name_if_any(skeleton_motion->motion);
    // A folder has several names, such as "walk", "walk/" and "."; its files count with their contents.
    if (auto* sequence = std::get_if<MeshSequence>(&character.source)) sequence->files.clear();
    keep_names_of_pictures(character.look);
  }
  for (Camera& camera : scene.cameras) keep_name(camera.file);
}

}  // namespace

std::string effective_scene(const Scene& scene) {
  return text_of(scene, KeySelection::all);
}

void identify(Scene& scene) {
  Fnv1a shown, simulated;
  for_each_dependency(scene, [&](const std::filesystem::path& file, std::string_view content, FileUse use) {
    scene.files.push_back(file);
    for (Fnv1a* hash : {&shown, &simulated}) {
      if (hash == &simulated && use == FileUse::pictures) continue;
      hash->add(fmt::format("{} ", content.size()));  // thus the hash depends on the boundaries between files
      hash->add(content);
    }
  });
  Scene copy = scene;
  keep_file_names(copy);
  shown.add(text_of(copy, KeySelection::all));
  simulated.add(text_of(copy, KeySelection::simulated));
  // The duration affects the motion of characters, because this motion is sampled into key frames up to the end of the
  // film, and the last key frames influence the interpolation before them.
  if (!scene.characters.empty()) simulated.add(fmt::format("{}", scene.time.duration));
  scene.hash = shown.value();
  scene.simulation_hash = simulated.value();
}

}  // namespace weft::scene
