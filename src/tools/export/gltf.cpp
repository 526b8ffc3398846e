#include "tools/export/gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/temporary_file.hpp"
#include "core/version.hpp"

namespace weft::exporter {
namespace {

// glTF is little endian, and numbers are copied as they are in memory.
static_assert(std::endian::native == std::endian::little);

using nlohmann::json;

// Constants of the glTF specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963, kTriangles = 4;

constexpr int kLinear = 9729, kLinearOfSizes = 9987;

int wrap_number(frame::Paint::Wrap wrap) {
  constexpr int kNumbers[] = {10497, 33071, 33648};  // repeat, clamp, mirror; no Material has Wrap::once
  return kNumbers[static_cast<std::size_t>(wrap)];
}

// Duplicates places (CutSurface) on creases, so that each place has one normal group (NormalGroups). Returns the group
// of each place; -1 for a place that no triangle uses.
std::vector<Index> cut_at_creases(CutSurface& cut, const NormalGroups& groups) {
  std::vector<Index> group_of(cut.vertex_of.size(), -1);
  std::map<std::pair<Index, Index>, Index> copies;  // by place and group
  for (std::size_t t = 0; t < cut.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      Index& corner = cut.triangles[t][k];
      const auto place = static_cast<std::size_t>(corner);
      const Index group = groups.of_corner[t][k];
      if (group_of[place] < 0) group_of[place] = group;
      if (group_of[place] == group) continue;
      const auto [copy, fresh] = copies.try_emplace({corner, group}, static_cast<Index>(cut.vertex_of.size()));
      if (fresh) {
        cut.vertex_of.push_back(cut.vertex_of[place]);
        if (!cut.uv.empty()) cut.uv.push_back(Vec2(cut.uv[place]));
        if (!cut.picture_uv.empty()) cut.picture_uv.push_back(Vec2(cut.picture_uv[place]));
        group_of.push_back(group);
      }
      corner = copy->second;
    }
  return group_of;
}

std::vector<float> difference(std::vector<float> now, const std::vector<float>& start) {
  for (std::size_t i = 0; i < now.size(); ++i) now[i] -= start[i];
  return now;
}

void append_number(std::string& bytes, std::uint32_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// Appends a chunk of the file, padded to a multiple of four bytes.
void append_chunk(std::string& bytes, const char* kind, std::string_view content, char filler) {
  const std::size_t fillers = (4 - content.size() % 4) % 4;
  append_number(bytes, static_cast<std::uint32_t>(content.size() + fillers));
  bytes.append(kind, 4);
  bytes.append(content).append(fillers, filler);
}

void check_size(const std::filesystem::path& file, std::size_t bytes) {
  if (bytes > std::numeric_limits<std::uint32_t>::max())
    throw Error(ExitCode::output_failed,
                "{}: glTF files end at 4 GiB, and this would be one of {:.3g} GB; export fewer frames with --frames",
                file.string(), 1e-9 * static_cast<double>(bytes));
}

}  // namespace

GltfFile::GltfFile(const frame::FrameSnapshot& first) : z_up_(first.stage->up.z() > 0.5), frames_{first.frame} {
  document_ = {{"asset", {{"version", "2.0"}, {"generator", fmt::format("Weft {}", kVersion)}}}, {"scene", 0}};
  for (const char* list :
       {"nodes", "meshes", "materials", "accessors", "bufferViews", "images", "samplers", "textures", "cameras"})
    document_[list] = json::array();
  for (std::size_t s = 0; s < first.surfaces.size(); ++s) {
    const frame::Surface& surface = *first.surfaces[s];
    if (!surface.visible) continue;
    const std::vector<Vec3>& positions = first.states[s].positions;
    const Materials materials = materials_of(surface);
    CutSurface cut = cut_at_seams(surface, materials, positions.size());
    Object object{.surface = s, .groups = group_normals(surface, positions)};
    object.group_of = cut_at_creases(cut, object.groups);
    object.vertex_of = cut.vertex_of;
    object.start = to_y_up(positions, object.vertex_of);
    object.start_normals = normals(object, first);
    document_["meshes"].push_back(
        {{"name", surface.name}, {"primitives", primitives(cut, object, surface, materials)}});
    objects_.push_back(std::move(object));
  }
}

std::vector<float> GltfFile::to_y_up(const std::vector<Vec3>& positions, const std::vector<Index>& vertices) const {
  std::vector<float> result;
  result.reserve(3 * vertices.size());
  for (const Index vertex : vertices) {
    const Vec3& x = positions[static_cast<std::size_t>(vertex)];
    const Vec3 y_up = z_up_ ? Vec3(x.x(), x.z(), -x.y()) : x;
    for (int axis = 0; axis < 3; ++axis) result.push_back(static_cast<float>(y_up[axis]));
  }
  return result;
}

std::vector<float> GltfFile::normals(const Object& object, const frame::FrameSnapshot& snapshot) const {
  const auto all =
      normals_of(object.groups, *snapshot.surfaces[object.surface], snapshot.states[object.surface].positions);
  std::vector<Vec3> of_place;
  std::vector<Index> places;
  for (const Index group : object.group_of) {
    places.push_back(static_cast<Index>(of_place.size()));
    of_place.push_back(group < 0 ? Vec3(0, 0, 1) : all[static_cast<std::size_t>(group)]);  // −1: not in any triangle
  }
  return to_y_up(of_place, places);
}

// Appends bytes to the buffer. Returns the index of their buffer view.
int GltfFile::append(const void* data, std::size_t size, int target) {
  json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
  if (target != 0) view["target"] = target;
  document_["bufferViews"].push_back(std::move(view));
  bytes_.append(static_cast<const char*>(data), size);
  return static_cast<int>(document_["bufferViews"].size()) - 1;
}

// Appends `count` numbers of four bytes to the buffer. Returns the index of their accessor. `type`: SCALAR, VEC2 and so
// on.
int GltfFile::add_numbers(const void* numbers, std::size_t count, int component_type, const char* type, int target) {
  const std::size_t each = type == std::string_view("SCALAR") ? 1 : type[3] - '0';
  document_["accessors"].push_back({{"bufferView", append(numbers, 4 * count, target)},
                                    {"componentType", component_type},
                                    {"count", count / each},
                                    {"type", type}});
  return static_cast<int>(document_["accessors"].size()) - 1;
}

int GltfFile::add_vectors(const std::vector<float>& vectors) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], vectors[i]);
    high[i % 3] = std::max(high[i % 3], vectors[i]);
  }
  const int accessor = add_numbers(vectors.data(), vectors.size(), kFloat, "VEC3", kVertices);
  document_["accessors"].back()["min"] = low;
  document_["accessors"].back()["max"] = high;
  return accessor;
}

int GltfFile::add_times() {
  const int accessor = add_numbers(times_.data(), times_.size(), kFloat, "SCALAR", 0);
  document_["accessors"].back()["min"] = {times_.front()};
  document_["accessors"].back()["max"] = {times_.back()};
  return accessor;
}

int GltfFile::add_places(const std::vector<Vec2>& places) {
  std::vector<float> uv;
  for (const Vec2& place : places) {  // v points down in glTF
    uv.push_back(static_cast<float>(place.x()));
    uv.push_back(static_cast<float>(1 - place.y()));
  }
  return add_numbers(uv.data(), uv.size(), kFloat, "VEC2", kVertices);
}

// Returns the index of the texture with the picture and the wrap modes of `material`. `images`: per
// picture, the index of its image; -1: not yet written.
json GltfFile::texture(const Materials& materials, const Material& material, std::vector<int>& images) {
  if (images.empty()) images.assign(materials.pictures.size(), -1);
  int& image = images[material.picture];
  if (image < 0) {
    const PictureFile& picture = materials.pictures[material.picture];
    const std::string png = picture.png();
    image = static_cast<int>(document_["images"].size());
    document_["images"].push_back(
        {{"name", picture.name}, {"mimeType", "image/png"}, {"bufferView", append(png.data(), png.size(), 0)}});
    bytes_.append((4 - bytes_.size() % 4) % 4, '\0');  // keeps later numbers aligned to four bytes
  }
  const json sampler{{"wrapS", wrap_number(material.wrap_u)},
                     {"wrapT", wrap_number(material.wrap_v)},
                     {"magFilter", kLinear},
                     {"minFilter", kLinearOfSizes}};
  const auto number_of = [&](const char* list, const json& entry) {
    json& all = document_[list];
    const auto found = std::ranges::find(all, entry);
    const auto number = static_cast<std::size_t>(found - all.begin());
    if (found == all.end()) all.push_back(entry);
    return number;
  };
  return number_of("textures", {{"source", image}, {"sampler", number_of("samplers", sampler)}});
}

// One primitive per look. All primitives share the vertices of the object, and therefore its morph targets.
json GltfFile::primitives(const CutSurface& cut, const Object& object, const frame::Surface& surface,
                          const Materials& materials) {
  json attributes{{"POSITION", add_vectors(object.start)}, {"NORMAL", add_vectors(object.start_normals)}};
  if (!cut.uv.empty()) attributes["TEXCOORD_0"] = add_places(cut.uv);
  if (!cut.picture_uv.empty()) attributes["TEXCOORD_1"] = add_places(cut.picture_uv);
  json result = json::array();
  std::vector<int> images;
  for (const MaterialGroup& group : group_by_look(surface, materials)) {
    const Material& look = materials.all[group.material];
    const bool painted = look.has_picture();
    const Vec3 color = painted ? Vec3(1, 1, 1) : look.color;
    json material{{"name", look.name},
                  {"doubleSided", surface.kind == frame::ObjectKind::cloth},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {color.x(), color.y(), color.z(), 1}},
                    {"metallicFactor", look.metal > 0 ? json(look.metal) : json(0)},
                    {"roughnessFactor", look.roughness}}}};
    if (painted)
      material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture(materials, look, images)},
                                                              {"texCoord", cut.picture_uv.empty() ? 0 : 1}};
    if (painted && look.cutout) material["alphaMode"] = "MASK";
    std::vector<std::array<Index, 3>> triangles;
    for (const std::size_t t : group.triangles) triangles.push_back(cut.triangles[t]);
    const int indices = add_numbers(triangles.data(), 3 * triangles.size(), kUnsignedInt, "SCALAR", kIndices);
    result.push_back({{"attributes", attributes},
                      {"indices", indices},
                      {"material", document_["materials"].size()},
                      {"mode", kTriangles}});
    document_["materials"].push_back(std::move(material));
  }
  return result;
}

void GltfFile::add(const frame::FrameSnapshot& snapshot, double time) {
  times_.push_back(static_cast<float>(time));
  frames_.push_back(snapshot.frame);
  for (Object& object : objects_) {
    const std::vector<float> positions = to_y_up(snapshot.states[object.surface].positions, object.vertex_of);
    Target target;
    if (positions != object.start) {
      target.positions = add_vectors(difference(positions, object.start));
      target.normals = add_vectors(difference(normals(object, snapshot), object.start_normals));
    }
    object.targets.push_back(target);
  }
}

void GltfFile::add_targets(Object& object, json& mesh) {
  int still = -1;  // accessor of zeros, shared by all frames that equal the first
  json targets = json::array(), names = json::array();
  for (std::size_t k = 0; k < object.targets.size(); ++k) {
    const auto [positions, normals] = object.targets[k];
    if (positions < 0 && still < 0) still = add_vectors(std::vector<float>(object.start.size(), 0.0F));
    targets.push_back({{"POSITION", positions < 0 ? still : positions}, {"NORMAL", positions < 0 ? still : normals}});
    names.push_back(fmt::format("frame_{:05}", frames_[k + 1]));
  }
  for (json& primitive : mesh["primitives"]) primitive["targets"] = targets;
  mesh["weights"] = std::vector<int>(object.targets.size(), 0);
  mesh["extras"] = {{"targetNames", std::move(names)}};
}

// The animation of all moving objects; they share one sampler of times and weights.
json GltfFile::animation(const std::vector<int>& nodes) {
  json result{{"samplers", json::array()}, {"channels", json::array()}};
  if (nodes.empty()) return result;
  const std::size_t targets = times_.size() - 1;
  std::vector<float> weights(times_.size() * targets, 0.0F);
  for (std::size_t k = 0; k < targets; ++k) weights[(k + 1) * targets + k] = 1;
  const int input = add_times(), output = add_numbers(weights.data(), weights.size(), kFloat, "SCALAR", 0);
  for (int node : nodes)
    result["channels"].push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
  result["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  return result;
}

void GltfFile::add_views(const std::vector<View>& views) {
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  if (z_up_) turned << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (std::size_t c = 0; c < views.size(); ++c) {
    if (c == camera_tracks_.size())
      camera_tracks_.push_back({.name = views[c].name, .field_of_view = views[c].field_of_view});
    CameraTrack& camera = camera_tracks_[c];
    const Vec3 position = turned * views[c].world_from_view.topRightCorner<3, 1>();
    Eigen::Vector4f turn =
        Quat(Eigen::Matrix3d(turned * views[c].world_from_view.topLeftCorner<3, 3>())).coeffs().cast<float>();
    // q and -q are the same rotation. The one nearer to the previous frame is written, so that readers interpolate
    // along the shorter arc.
    if (!camera.turns.empty() && turn.dot(Eigen::Map<const Eigen::Vector4f>(&*(camera.turns.end() - 4))) < 0)
      turn = -turn;
    for (int axis = 0; axis < 3; ++axis) camera.positions.push_back(static_cast<float>(position[axis]));
    for (int part = 0; part < 4; ++part) camera.turns.push_back(turn[part]);
  }
}

// Adds cameras as nodes after those of the objects.
void GltfFile::add_cameras(json& animation, double aspect) {
  for (const CameraTrack& camera : camera_tracks_) {
    const std::size_t node = document_["nodes"].size();
    document_["nodes"].push_back({{"name", camera.name},
                                  {"camera", document_["cameras"].size()},
                                  {"translation", std::vector(camera.positions.begin(), camera.positions.begin() + 3)},
                                  {"rotation", std::vector(camera.turns.begin(), camera.turns.begin() + 4)}});
    document_["cameras"].push_back({{"name", camera.name},
                                    {"type", "perspective"},
                                    {"perspective",
                                     {{"yfov", camera.field_of_view * std::numbers::pi / 180},
                                      {"aspectRatio", aspect},
                                      {"znear", kNearPlane},
                                      {"zfar", kFarPlane}}}});
    for (const auto& [path, type, values] :
         {std::tuple("translation", "VEC3", &camera.positions), std::tuple("rotation", "VEC4", &camera.turns)}) {
      const std::ptrdiff_t each = type[3] - '0';
      // A value that never changes needs no channel.
      if (std::equal(values->begin() + each, values->end(), values->begin())) continue;
      const int input = animation["samplers"].empty() ? add_times() : animation["samplers"][0]["input"].get<int>(),
                output = add_numbers(values->data(), values->size(), kFloat, type, 0);
      animation["channels"].push_back(
          {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
      animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
    }
  }
}

void GltfFile::write(const std::filesystem::path& file, const std::string& animation_name, double aspect) {
  const auto is_still = [](const Object& object) {
    return std::ranges::all_of(object.targets, [](const Target& target) { return target.positions < 0; });
  };
  // The number of weights is nearly the square of the number of frames, so check their size before allocating them.
  const std::size_t targets = std::ranges::all_of(objects_, is_still) ? 0 : times_.size() - 1;
  check_size(file, bytes_.size() + sizeof(float) * targets * times_.size());
  std::vector<int> moving;
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    json& mesh = document_["meshes"][o];
    document_["nodes"].push_back({{"name", mesh["name"]}, {"mesh", o}});
    if (is_still(objects_[o])) continue;
    add_targets(objects_[o], mesh);
    moving.push_back(static_cast<int>(o));
  }
  json moved = animation(moving);
  add_cameras(moved, aspect);
  std::vector<std::size_t> all(document_["nodes"].size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  document_["scenes"] = {{{"nodes", all}}};
  if (!moved["channels"].empty()) {
    moved["name"] = animation_name;
    document_["animations"].push_back(std::move(moved));
  }
  for (const char* list : {"images", "samplers", "textures", "cameras"})
    if (document_[list].empty()) document_.erase(list);
  document_["buffers"] = {{{"byteLength", bytes_.size()}}};

  const std::string text = sorted_json_text(document_);
  const std::size_t max_size = text.size() + bytes_.size() + 64;  // upper bound, with headers and padding
  check_size(file, max_size);
  std::string whole = "glTF";
  whole.reserve(max_size);
  append_number(whole, 2);
  append_number(whole, 0);  // total length, set below
  append_chunk(whole, "JSON", text, ' ');
  append_chunk(whole, "BIN", bytes_, '\0');
  const auto length = static_cast<std::uint32_t>(whole.size());
  std::memcpy(whole.data() + 8, &length, sizeof length);
  write_file(file, whole, Flush::no);
}

}  // namespace weft::exporter
