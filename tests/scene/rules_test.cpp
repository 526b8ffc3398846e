// Compares the rule table with all that is derived from it: reading, the effective scene, the hash, the schema.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "film/scene/loader.hpp"
#include "film/scene/rule.hpp"
#include "scene/folder.hpp"
#include "scene/json_schema_check.hpp"
#include "support/test_folder.hpp"

namespace weft::scene {
namespace {

using nlohmann::json;

/// One entry of each kind, as small as possible.
const std::string kOneOfEach = R"(
cloth = [{ name = "c", pin = [{}] }]
camera = [{ name = "v", position = [1, 2, 3], target = [0, 0, 0] }]
light = [{ name = "sun" }, { name = "spot", kind = "spot" }]
[[obstacle]]
name = "mesh"
shape = "mesh"
file = "triangle.obj"
[[obstacle]]
name = "sphere"
shape = "sphere"
[[character]]
name = "dancer"
file = "triangle.obj"
[[character]]
name = "film"
source = "sequence"
files = "frames"
)";

LoadResult load_here(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return load_text(text, kFolder + "text.toml", overrides);
}

/// TOML text of a value that the rule allows and that differs from its default `now`.
std::string another_value(const Rule& rule, const Value& now) {
  if (rule.type == Type::boolean) return std::get<bool>(now) ? "false" : "true";
  if (rule.type == Type::text) return "\"another_text\"";
  if (rule.type == Type::texts) return "[\"another_text\"]";
  if (rule.type == Type::choice) {
    return "\"" + (rule.choices.back() == std::get<std::string>(now) ? rule.choices.front() : rule.choices.back()) +
           "\"";
  }
  // Distinct numbers near the lower end of the range, or near 0 if the range contains 0.
  const double from = std::max(rule.range.low, 0.0);
  const double width = std::min(rule.range.high - from, 10.0);
  std::string text;
  const std::size_t count = std::max<std::size_t>(1, rule.components.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double fraction = 0.031 * static_cast<double>(i + 1);
    const double number = rule.whole ? from + 3 + static_cast<double>(i) : from + width * fraction;
    text += (i > 0 ? ", " : "") + std::to_string(number);
    if (rule.whole) text.resize(text.find('.', text.rfind(' ') == std::string::npos ? 0 : text.rfind(' ')));
  }
  return rule.components.empty() ? text : "[" + text + "]";
}

/// Calls visit(path, rule, default value) for each key with a value, in `table` and in all tables below it.
template <class Visit>
void for_each_value(const Table& table, const std::string& path, const Visit& visit) {
  const auto defaults = table.make();
  const auto visit_rule = [&](const Rule& rule, const std::string& at) {
    if (rule.type == Type::table) {
      for_each_value(*rule.table, at + rule.key + ".", visit);
    } else if (rule.get) {
      visit(at + rule.key, rule, rule.get(defaults.get()));
    }
  };
  for (const Rule& rule : table.rules) {
    if (rule.type != Type::list) visit_rule(rule, path);
  }
}

void expect_change(const std::string& text, const std::string& override_text) {
  const LoadResult before = load_here(text);
  const LoadResult after = load_here(text, {override_text});
  ASSERT_EQ(before.describe(), "");
  ASSERT_EQ(after.describe(), "");
  EXPECT_NE(before.scene.hash, after.scene.hash) << override_text;
  EXPECT_NE(effective_scene(before.scene), effective_scene(after.scene)) << override_text;
}

/// Whether the key can be set alone. This is false for names, references, files, and keys that require another key;
/// scene_test covers these.
bool is_plain_value(const std::string& path, const Rule& rule) {
  const bool needs_mass = path.starts_with("obstacle.") &&
                          (path.ends_with("velocity") || path.ends_with("spin") || path.ends_with("release"));
  if (needs_mass) return false;
  return rule.type != Type::name && rule.type != Type::file && rule.type != Type::texts && !path.ends_with("follow") &&
         !path.ends_with("edge") && !path.ends_with("panel") && !path.ends_with("vertex_group") &&
         !path.ends_with("vertex_color") && !path.ends_with("follow_rotation") && !path.ends_with("sensor_width") &&
         !path.ends_with("fade") && !path.ends_with("grow") && path != "render.camera" &&
         path != "physics.interpolation" && !path.ends_with("shape") && !path.ends_with("kind") &&
         !path.ends_with("source");
}

TEST(Rules, EachKeyChangesTheSceneAndItsHash) {
  std::set<std::string> paths;
  const auto try_rule = [&](const std::string& path, const Rule& rule, const Value& now) {
    if (!is_plain_value(path, rule)) return;
    paths.insert(path);
    expect_change(kOneOfEach, path + "=" + another_value(rule, now));
  };
  const Table& root = scene_rules();
  for_each_value(root, "", try_rule);
  for_each_value(*root.find("cloth")->table, "cloth.c.", try_rule);
  for_each_value(*root.find("cloth")->table->find("pin")->table, "cloth.c.pin.0.",
                 [&](const auto& path, const auto& rule, const auto& now) {
                   // Excludes a few rows at one side only, so that the pin still holds some particles.
                   if (rule.key == "low") return expect_change(kOneOfEach, path + "=[0.1, 0.2]");
                   if (rule.key == "high") return expect_change(kOneOfEach, path + "=[0.8, 0.9]");
                   try_rule(path, rule, now);
                 });
  for_each_value(*root.find("obstacle")->table, "obstacle.sphere.", try_rule);
  for_each_value(*root.find("character")->table, "character.dancer.", try_rule);
  for_each_value(*root.find("camera")->table, "camera.v.", try_rule);
  for_each_value(*root.find("light")->table, "light.sun.", try_rule);
  // Samples that the traversal has reached all tables.
  EXPECT_TRUE(paths.contains("up"));
  EXPECT_TRUE(paths.contains("cloth.c.material.bend_viscosity"));
  EXPECT_TRUE(paths.contains("obstacle.sphere.look.checker"));
  EXPECT_TRUE(paths.contains("cloth.c.look.image_width"));
}

TEST(Rules, EachKeyOfAVariantChangesTheSceneAndItsHash) {
  for (const std::string list : {"obstacle", "cloth", "character", "light"}) {
    const Table& table = *scene_rules().find(list)->table;
    for (const Variant& variant : table.variants) {
      const std::string file = variant.name == "mesh" || variant.name == "pattern" ? ", file = 'triangle.obj'"
                               : variant.name == "file"      ? ", file = 'triangle.obj', blend = 1, dressing = 60"
                               : variant.name == "mannequin" ? ", blend = 1, dressing = 60"
                               : variant.name == "sequence"  ? ", files = 'frames'"
                                                             : "";
      std::string text = list + " = [{ name = 'x', " + table.selector + " = '" + variant.name + "'" + file + " }]\n";
      if (list == "light") text += "cloth = [{ name = 'c' }]\n";
      if (list == "cloth") text += "character = [{ name = 'another_text', source = 'mannequin' }]\n";  // as its wearer
      const auto defaults = table.make();
      table.find(table.selector)->set(defaults.get(), variant.name);
      for (const Rule& rule : variant.rules) {
        if (!rule.get || rule.type == Type::file || rule.key == "files") continue;
        expect_change(text, list + ".x." + rule.key + "=" + another_value(rule, rule.get(defaults.get())));
      }
    }
  }
}

TEST(EffectiveScene, ReadsBackAsTheSameScene) {
  const LoadResult first = load(kFolder + "every_key.toml");
  ASSERT_EQ(first.describe(), "");
  const std::string text = effective_scene(first.scene);
  const LoadResult second = load_text(text, "/elsewhere/effective.toml");
  ASSERT_EQ(second.describe(), "");
  EXPECT_EQ(effective_scene(second.scene), text);
  EXPECT_EQ(second.scene.hash, first.scene.hash);
}

TEST(EffectiveScene, KeepsWholeTurnsOfKeys) {
  const LoadResult loaded = load_here(
      "obstacle = [{ name = 'a', shape = 'box', keys = [{ time = 0 }, { time = 1, rotation = [0, 1080, 0] },"
      " { time = 2, position = [1, 0, 0] }, { time = 3, quaternion = [1, 0, 0, 0] }] }]\n");
  const std::string text = effective_scene(loaded.scene);
  EXPECT_NE(text.find("position = [0, 0, 0], rotation = [0, 1080, 0]"), std::string::npos) << text;
  EXPECT_NE(text.find("position = [1, 0, 0], rotation = [0, 1080, 0]"), std::string::npos) << text;
  EXPECT_NE(text.find("position = [1, 0, 0], quaternion = [1, 0, 0, 0]"), std::string::npos) << text;
}

TEST(Effective, SaysEitherStepOrTolerance) {
  const std::string cloth = "[[cloth]]\nname = 'a'\n[time]\n";
  const std::string by_step = effective_scene(load_here(cloth).scene);
  EXPECT_NE(by_step.find("step = 0.01\n"), std::string::npos);
  EXPECT_EQ(by_step.find("tolerance = 1e-04"), std::string::npos);
  const std::string by_tolerance = effective_scene(load_here(cloth + "tolerance = 1e-4\n").scene);
  EXPECT_NE(by_tolerance.find("tolerance = 0.0001\n"), std::string::npos);
  EXPECT_EQ(by_tolerance.find("step = "), std::string::npos);
  EXPECT_EQ(load_here(by_tolerance).describe(), "");
}

TEST(Hash, LeavesOutCommentsOrderSpellingAndGivenDefaults) {
  const auto hash = [](const std::string& text) {
    const LoadResult result = load_here(text);
    EXPECT_EQ(result.describe(), "");
    return result.scene.hash;
  };
  const std::string plain = "[[cloth]]\nname = 'a'\nsize = [2, 1]\n[time]\nstep = 0.005\n";
  EXPECT_EQ(hash(plain),
            hash("# a comment\n[time]\nstep = 5e-3 # spelt otherwise\n[[cloth]]\nsize = [2.0, 1]\nname = \"a\"\n"));
  EXPECT_EQ(hash(plain), hash(plain + "fps = 25\nduration = 5.0\n")) << "defaults, written out";
  EXPECT_EQ(hash(plain), hash(plain + "[physics]\nwind = [-0.0, 0, 0]\n")) << "0 has one hash";
  EXPECT_NE(hash(plain), hash(plain + "fps = 24\n"));
}

TEST(Hash, KnowsTheContentOfMeshFilesAndNotTheirFolder) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("weft_scene_hash_" + std::to_string(getpid()));
  const std::string text = "obstacle = [{ name = 'm', shape = 'mesh', file = 'm.obj' }]\n";
  const auto hash_with = [&](const std::string& place, const std::string& mesh) {
    fs::create_directories(folder / place);
    std::ofstream(folder / place / "m.obj") << mesh;
    const LoadResult result = load_text(text, folder / place / "s.toml");
    EXPECT_EQ(result.describe(), "");
    return result.scene.hash;
  };
  const auto hash = hash_with("here", "v 0 0 0\n");
  EXPECT_EQ(hash, hash_with("there", "v 0 0 0\n"));
  EXPECT_NE(hash, hash_with("here", "v 0 0 1\n"));
  fs::remove_all(folder);
}

TEST(Hash, IsFnv1aOfTheEffectiveSceneAndSoTheSameOnEveryMachine) {
  const Scene scene = load_here("cloth = [{ name = 'a' }]\n").scene;
  std::uint64_t expected = 0xcbf29ce484222325;  // offset basis and prime of 64-bit FNV-1a
  for (const unsigned char byte : effective_scene(scene)) {
    expected ^= byte;
    expected *= 0x100000001b3;
  }
  EXPECT_EQ(scene.hash, expected);
}

void expect_in_schema(const Table& table, const json& schema, const std::string& path);

void expect_in_properties(const std::vector<Rule>& rules, const json& properties, const std::string& path) {
  for (const Rule& rule : rules) {
    ASSERT_TRUE(properties.contains(rule.key)) << path << rule.key;
    const json& property = properties[rule.key];
    const auto description = property["description"].get<std::string>();
    EXPECT_NE(description.find(rule.documentation), std::string::npos) << path << rule.key;
    if (!rule.unit.empty()) {
      EXPECT_NE(description.find("[" + rule.unit + "]"), std::string::npos) << path << rule.key;
    }
    if (rule.table == nullptr) continue;
    const json& inner = rule.type == Type::table ? property : property["items"];
    expect_in_schema(*rule.table, inner, path + rule.key + ".");
  }
}

void expect_in_schema(const Table& table, const json& schema, const std::string& path) {
  if (table.variants.empty()) return expect_in_properties(table.rules, schema["properties"], path);
  ASSERT_EQ(schema["allOf"].size(), table.variants.size());
  for (std::size_t i = 0; i < table.variants.size(); ++i) {
    const json& condition = schema["allOf"][i];
    EXPECT_EQ(condition["if"]["properties"][table.selector]["enum"], json({table.variants[i].name}));
    json properties = condition["then"]["properties"];
    for (auto& [key, property] : properties.items())
      if (property == true) property = schema["properties"][key];
    expect_in_properties(table.rules, properties, path);
    expect_in_properties(table.variants[i].rules, properties, path);
  }
}

TEST(Schema, HasEachRuleWithItsDocumentationAndUnit) {
  const json schema = json::parse(json_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  expect_in_schema(scene_rules(), schema, "");
}

TEST(Schema, StatesTypeRangeDefaultAndChoices) {
  const json schema = json::parse(json_schema());
  const json& time = schema["properties"]["time"];
  EXPECT_EQ(time["additionalProperties"], false);
  const json& fps = time["properties"]["fps"];
  EXPECT_EQ(fps["type"], "number");
  EXPECT_EQ(fps["exclusiveMinimum"], 0);
  EXPECT_FALSE(fps.contains("minimum"));
  EXPECT_TRUE(schema["properties"]["cloth"]["maxItems"].is_number_integer());
  EXPECT_EQ(fps["maximum"], 1000);
  EXPECT_EQ(fps["default"], 25);
  EXPECT_EQ(time["properties"]["integrator"]["enum"], json({"implicit_euler", "implicit_midpoint", "bdf2"}));
  EXPECT_EQ(schema["properties"]["cloth"]["items"]["required"], json({"name"}));
}

TEST(Schema, AcceptsWhatTheLoaderAccepts) {
  const json schema = json::parse(json_schema());
  EXPECT_EQ(schema_violation(schema, json_of_toml(support::read_bytes(kFolder + "every_key.toml"))), "");
  EXPECT_EQ(schema_violation(schema, json_of_toml(kOneOfEach)), "");
  EXPECT_EQ(schema_violation(schema, json_of_toml(effective_scene(load(kFolder + "every_key.toml").scene))), "");
}

TEST(Schema, RefusesWhatTheLoaderRefuses) {
  const json schema = json::parse(json_schema());
  const auto violation = [&](const std::string& text) { return schema_violation(schema, json_of_toml(text)); };
  EXPECT_EQ(violation("[time]\nfps = 0\n"), "time.fps: below minimum");
  EXPECT_EQ(violation("[time]\nduraton = 1\n"), "time.duraton: unknown property");
  EXPECT_EQ(violation("[contact]\nself = 1\n"), "contact.self: wrong type");
  EXPECT_EQ(violation("[physics]\nwind = [1, 2]\n"), "physics.wind: wrong number of items");
  EXPECT_EQ(violation("cloth = [{ name = 'a', pin = [1] }]\n"), "cloth.0.pin.0: wrong type");
  EXPECT_EQ(violation("[render]\nsky_color = '#12'\n"), "render.sky_color: none of the choices fits");
  EXPECT_EQ(violation("camera = [{ name = '1', position = [1, 2, 3], target = [0, 0, 0] }]\n"),
            "camera.0.name: wrong pattern");
}

TEST(Schema, NamesTheKeyThatAVariantDoesNotHave) {
  const json schema = json::parse(json_schema());
  const auto violation = [&](const std::string& text) { return schema_violation(schema, json_of_toml(text)); };
  EXPECT_EQ(violation("obstacle = [{ name = 'a', shape = 'sphere', height = 1 }]\n"),
            "obstacle.0.height: unknown property");
  EXPECT_EQ(violation("cloth = [{ name = 'a', particels = [3, 3] }]\n"), "cloth.0.particels: unknown property");
  // The size of a plane is one number or two; that of a box is three.
  EXPECT_EQ(violation("obstacle = [{ name = 'a', shape = 'plane', size = 2 }]\n"), "");
  EXPECT_EQ(violation("obstacle = [{ name = 'a', shape = 'box', size = [2, 2] }]\n"),
            "obstacle.0.size: wrong number of items");
  EXPECT_EQ(violation("obstacle = [{ name = 'a', shape = 'ball' }]\n"), "obstacle.0.shape: not one of the choices");
  EXPECT_EQ(violation("obstacle = [{ name = 'a', radius = 1 }]\n"), "obstacle.0: shape is missing");
}

}  // namespace
}  // namespace weft::scene
