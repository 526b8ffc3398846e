#include "tools/export/blender.hpp"

#include <fmt/format.h>

#include "core/json.hpp"
#include "core/version.hpp"
#include "embedded_export.hpp"
#include "film/image/color.hpp"
#include "tools/export/materials.hpp"

namespace weft::exporter {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json light_json(const frame::Light& light, double fraction) {
  const bool sun = light.kind == frame::Light::Kind::sun;
  return {{"name", light.name},
          {"kind", sun ? "sun" : "spot"},
          {"position", list(sun ? Vec3(0, 0, 0) : light.position)},
          {"direction", list(sun ? light.direction : Vec3(light.target - light.position))},
          {"color", list(image::linear_from_srgb(light.color))},
          {"strength", light.intensity * fraction},
          {"cone_angle", light.cone_angle},
          {"softness", light.softness}};
}

const char* extension(const Material& material) {
  constexpr const char* kNames[] = {"REPEAT", "EXTEND", "MIRROR"};  // no Material has Wrap::once
  return kNames[static_cast<std::size_t>(material.wrap_u)];
}

// An object with what MTL cannot express, by name of the material: `pictures`, the picture and its mapping, and
// `backs`, Material::back.
Json object_json(const frame::Surface& surface) {
  Json pictures = Json::object(), backs = Json::object();
  const Materials materials = materials_of(surface);
  for (const MaterialGroup& group : group_by_look(surface, materials)) {
    const Material& material = materials.all[group.material];
    if (material.back) backs[material.name] = list(*material.back);
    if (!material.has_picture()) continue;
    const auto& map = material.picture_from_uv;
    pictures[material.name] = {{"file", materials.pictures[material.picture].name},
                               {"across", {map(0, 0), map(0, 1), map(0, 2)}},
                               {"up", {map(1, 0), map(1, 1), map(1, 2)}},
                               {"extension", extension(material)},
                               {"cutout", material.cutout}};
  }
  return {{"name", surface.name}, {"visible", surface.visible}, {"pictures", pictures}, {"backs", backs}};
}

}  // namespace

BlenderScript::BlenderScript(const frame::FrameSnapshot& first, const Lighting& lighting, std::string name, double fps,
                             int width, int height) {
  film_ = {{"name", std::move(name)},
           {"fps", fps},
           {"size", {width, height}},
           {"z_up", first.stage->up.z() > 0.5},
           {"first", first.frame},
           {"last", first.frame},
           {"frames", Json::array()},
           {"objects", Json::array()},
           {"cameras", Json::array()},
           {"lights", Json::array()},
           {"sky", {{"color", list(lighting.sky_color)}, {"strength", lighting.sky_fraction}}}};
  for (const auto& surface : first.surfaces) film_["objects"].push_back(object_json(*surface));
  for (const frame::Light& light : lighting.lights)
    film_["lights"].push_back(light_json(light, 1 - lighting.sky_fraction));
}

void BlenderScript::add(int frame, const std::vector<View>& views) {
  film_["last"] = frame;
  film_["frames"].push_back(frame);
  Json& cameras = film_["cameras"];
  for (std::size_t c = 0; c < views.size(); ++c) {
    if (c == cameras.size()) cameras.push_back({{"name", views[c].name}, {"frames", Json::array()}});
    Json key{views[c].field_of_view};
    for (int row = 0; row < 3; ++row) {
      const Eigen::RowVector4d r = views[c].world_from_view.row(row);
      key.push_back({r[0], r[1], r[2], r[3]});
    }
    cameras[c]["frames"].push_back(std::move(key));
  }
}

std::string BlenderScript::text() const {
  // JSON never contains three consecutive quotes, so the data cannot end the Python string early.
  const std::string data = json_text(film_, -1, JsonLetters::ascii);
  std::string text = fmt::format("# {}, by Weft {}.\nFILM_TEXT = r\"\"\"{}\"\"\"\n\n",
                                 json_text(film_["name"], -1, JsonLetters::ascii), kVersion, data);
  for (const EmbeddedFile& file : kEmbeddedExport)
    if (file.name == "blender.py") text += file.text;
  return text;
}

}  // namespace weft::exporter
