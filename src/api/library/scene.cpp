#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <weft/scene.hpp>

#include "api/library/scene_data.hpp"
#include "api/physics_library/material_members.hpp"
#include "film/scene/fabrics.hpp"
#include "film/scene/loader.hpp"

namespace weft {
namespace {

std::vector<Mistake> public_mistakes(const scene::LoadResult& loaded) {
  std::vector<Mistake> mistakes;
  for (const scene::Mistake& mistake : loaded.mistakes) {
    std::string change = mistake.override_text;  // "--set key=value"
    if (!change.empty()) change.erase(0, change.find(' ') + 1);
    mistakes.push_back({loaded.file.string(), mistake.line, mistake.column, change, mistake.key, mistake.text});
  }
  return mistakes;
}

Scene checked(scene::LoadResult loaded, std::vector<std::vector<std::string>> changes) {
  if (!loaded.ok()) {
    std::string lines = loaded.describe();
    lines.pop_back();  // the last line feed
    throw SceneError(lines, public_mistakes(loaded));
  }
  return Scene(std::make_shared<const Scene::Data>(
      Scene::Data{std::move(loaded.scene), std::move(loaded.text), std::move(loaded.file), std::move(changes)}));
}

}  // namespace

Scene::Scene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Scene Scene::load(const std::filesystem::path& file, const std::vector<std::string>& changes) {
  return checked(scene::load(file, changes), {changes});
}

Scene Scene::parse(std::string_view toml, const std::vector<std::string>& changes, const std::filesystem::path& name) {
  return library::scene_of(toml, name, name, {changes});
}

Scene Scene::with(const std::vector<std::string>& changes) const {
  std::vector<std::vector<std::string>> all = data_->changes;
  all.push_back(changes);
  // The scene is loaded with its absolute path, because the working folder may have changed. Mistakes show the path
  // that the caller gave.
  return library::scene_of(data_->text, data_->scene.file, data_->file, std::move(all));
}

const std::string& Scene::name() const {
  return data_->scene.name;
}
double Scene::fps() const {
  return data_->scene.time.fps;
}
int Scene::frames() const {
  return data_->scene.frame_count();
}
std::vector<std::string> Scene::cloths() const {
  return library::names_of(data_->scene.cloths);
}
std::vector<std::string> Scene::obstacles() const {
  return library::names_of(data_->scene.obstacles);
}
std::string Scene::text() const {
  return scene::effective_scene(data_->scene);
}

Material fabric(std::string_view name) {
  const scene::Fabric* found = scene::find_fabric(name);
  if (found == nullptr)
    throw std::invalid_argument(
        fmt::format("expected one of the fabrics {}, got {}", fmt::join(scene::fabric_names(), ", "), name));
  Material material;
  for (const library::MaterialMember& member : library::kMaterialMembers)
    material.*member.given = found->material.*member.physics;
  return material;
}

}  // namespace weft

namespace weft::library {

Scene scene_of(std::string_view text, const std::filesystem::path& name, const std::filesystem::path& shown,
               std::vector<std::vector<std::string>> changes) {
  scene::LoadResult loaded = scene::load_batches(text, name, changes);
  loaded.file = shown;
  return checked(std::move(loaded), std::move(changes));
}

}  // namespace weft::library
