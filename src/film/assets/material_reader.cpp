#include "film/assets/material_reader.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "core/input_file.hpp"
#include "film/assets/import.hpp"
#include "film/assets/source.hpp"
#include "film/image/picture.hpp"

namespace weft::assets {
namespace {

namespace fs = std::filesystem;
using character::Material;

/// The type of the texture with the colour of the surface: base colour (physically based) if the material has it, else
/// diffuse colour.
std::optional<aiTextureType> picture_type(const aiMaterial& material) {
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE})
    if (material.GetTextureCount(type) > 0) return type;
  return std::nullopt;
}

Material::Wrap to_wrap(int mode) {
  switch (mode) {
    case aiTextureMapMode_Clamp:
      return Material::Wrap::clamp;
    case aiTextureMapMode_Mirror:
      return Material::Wrap::mirror;
    case aiTextureMapMode_Decal:
      return Material::Wrap::once;
    default:
      return Material::Wrap::repeat;
  }
}

bool is_picture(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.starts_with("\xff\xd8\xff") || image::is_targa(bytes);
}

/// Folders in which programs store pictures: first those beside the file, then those beside its folder; each sorted by
/// name.
std::vector<fs::path> picture_folders(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::vector<fs::path> folders;
  for (const fs::path& place : {file.parent_path(), file.parent_path().parent_path()}) {
    const std::size_t first = folders.size();
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(place.empty() ? "." : place, error)) {
      const std::string name = entry.path().filename().string(), lower = lower_case(name);
      if (name == stem || name == stem + ".fbm" || lower == "textures" || lower == "texture" || lower == "images" ||
          lower == "tex")
        folders.push_back(entry.path());
    }
    std::sort(folders.begin() + static_cast<std::ptrdiff_t>(first), folders.end());
  }
  return folders;
}

/// Finds a picture file. Tries the path as given. Then tries its file name beside `file` and in picture_folders(),
/// because FBX and Collada store paths of the machine that wrote them.
std::optional<fs::path> find_file(const std::string& texture_path, const fs::path& file) {
  std::string plain = texture_path.starts_with("file://") ? texture_path.substr(7) : texture_path;
  std::ranges::replace(plain, '\\', '/');
  const fs::path folder = file.parent_path();
  for (const fs::path path : {plain, percent_decode(plain)}) {
    std::vector<fs::path> places{folder / path, folder / path.filename()};
    for (const fs::path& each : picture_folders(file)) places.push_back(each / path.filename());
    for (const fs::path& at : places) {
      std::error_code error;
      if (fs::is_regular_file(at, error)) return at;
    }
  }
  return std::nullopt;
}

/// Whether a path names no picture. If FBX declares a picture without name or content, assimp returns the current
/// folder as its path.
bool is_nameless(const std::string& texture_path) {
  return texture_path.empty() || texture_path == "." || texture_path == "./" || texture_path == ".\\";
}

constexpr const char* kNameless = "neither named nor held by the file";

/// The bytes of a picture. If the picture cannot be used, returns an empty string and sets `reason`.
std::string read_picture(const aiScene& scene, const aiString& texture_path, const fs::path& file,
                         std::string& reason) {
  std::string bytes;
  if (const aiTexture* inside = scene.GetEmbeddedTexture(texture_path.C_Str())) {
    if (inside->mHeight != 0) {
      reason = "raw pixels are not read";
      return {};
    }
    bytes.assign(reinterpret_cast<const char*>(inside->pcData), inside->mWidth);
  } else if (is_nameless(texture_path.C_Str())) {
    reason = kNameless;
    return {};
  } else {
    const std::optional<fs::path> found = find_file(texture_path.C_Str(), file);
    if (!found) {
      reason = "not there";
      return {};
    }
    try {
      bytes = read_bytes(*found, image::kMaxPictureBytes);
    } catch (const std::runtime_error& error) {
      reason = error.what();
      return {};
    }
  }
  if (is_picture(bytes)) return bytes;
  reason = "neither PNG, JPEG nor TGA";
  return {};
}

Vec3 base_color(const aiMaterial& material) {
  aiColor4D color;
  if (material.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != AI_SUCCESS)
    return Vec3::Constant(0.6);
  const Vec3 rgb(color.r, color.g, color.b);
  return rgb.allFinite() ? Vec3(rgb.cwiseMax(0).cwiseMin(1)) : Vec3(Vec3::Constant(0.6));
}

/// Whether transparent parts are holes: in glTF, if the alpha mode is not OPAQUE; in other formats, if the material has
/// an opacity picture.
bool is_cutout(const aiMaterial& material) {
  aiString mode;
  if (material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == AI_SUCCESS) return std::string_view(mode.C_Str()) != "OPAQUE";
  return material.GetTextureCount(aiTextureType_OPACITY) > 0;
}

/// Pictures that were skipped for the same reason.
struct LeftOut {
  std::string reason;
  std::vector<std::string> materials, pictures;  // names of the materials; paths of their pictures, each may be ""
};

/// Text with the first three names, quoted, and the number of the others.
std::string quote_some(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxQuotedNames = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMaxQuotedNames); ++i)
    text += fmt::format("{}\"{}\"", i > 0 ? ", " : "", names[i]);
  return names.size() > kMaxQuotedNames ? fmt::format("{} and {} more", text, names.size() - kMaxQuotedNames) : text;
}

std::string describe_left_out(const LeftOut& left_out) {
  const auto& [reason, materials, pictures] = left_out;
  const bool several = materials.size() > 1;
  return fmt::format("material{0} {1}: picture{0}{2} {3} left out: {4}", several ? "s" : "", quote_some(materials),
                     reason == kNameless ? "" : " " + quote_some(pictures), several ? "are" : "is", reason);
}

}  // namespace

unsigned uv_channel(const aiMaterial& material) {
  int channel = 0;
  if (const auto type = picture_type(material)) material.Get(AI_MATKEY_UVWSRC(*type, 0), channel);
  return channel < 0 || channel >= AI_MAX_NUMBER_OF_TEXTURECOORDS ? 0 : static_cast<unsigned>(channel);
}

Vec2 placed_uv(const aiMaterial& material, const Vec2& uv) {
  const auto type = picture_type(material);
  aiString mode;
  aiUVTransform placing;
  const bool is_gltf = material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == AI_SUCCESS;
  if (!type || !is_gltf || material.Get(AI_MATKEY_UVTRANSFORM(*type, 0), placing) != AI_SUCCESS) return uv;
  // In glTF, v points down, and a picture turns about the origin. assimp has converted the offset: to v upward, and to
  // a rotation by −angle about the middle of the picture. This restores the offset that the glTF file contains.
  const double cos = std::cos(placing.mRotation), sin = -std::sin(placing.mRotation);
  const Vec2 scale(placing.mScaling.x, placing.mScaling.y),
      offset(placing.mTranslation.x - scale.x() / 2 * (1 - cos + sin),
             1 - scale.y() + scale.y() / 2 * (sin + cos - 1) - placing.mTranslation.y);
  const double u = scale.x() * uv.x(), v = scale.y() * (1 - uv.y());
  return {offset.x() + cos * u + sin * v, 1 - (offset.y() - sin * u + cos * v)};
}

std::vector<Material> read_materials(const aiScene& scene, const fs::path& file, std::vector<std::string>& warnings) {
  std::vector<Material> materials;
  std::vector<LeftOut> left_out;
  for (const aiMaterial* from : std::span(scene.mMaterials, scene.mNumMaterials)) {
    Material& material = materials.emplace_back();
    material.name = from->GetName().C_Str();
    material.color = base_color(*from);
    const auto type = picture_type(*from);
    if (!type) continue;
    aiString texture_path;
    from->GetTexture(*type, 0, &texture_path);
    int wrap_u = aiTextureMapMode_Wrap, wrap_v = aiTextureMapMode_Wrap;
    from->Get(AI_MATKEY_MAPPINGMODE_U(*type, 0), wrap_u);
    from->Get(AI_MATKEY_MAPPINGMODE_V(*type, 0), wrap_v);
    material.wrap_u = to_wrap(wrap_u);
    material.wrap_v = to_wrap(wrap_v);
    std::string reason;
    material.picture = read_picture(scene, texture_path, file, reason);
    material.cutout = !material.picture.empty() && is_cutout(*from);
    if (material.picture.empty()) {
      auto same = std::ranges::find(left_out, reason, &LeftOut::reason);
      if (same == left_out.end()) same = left_out.insert(same, {reason, {}, {}});
      same->materials.push_back(material.name);
      same->pictures.emplace_back(texture_path.C_Str());
    } else if (*type == aiTextureType_DIFFUSE) {
      // Ignores the diffuse colour, because files often have a dark or black one in addition to a picture that replaces
      // it.
      material.color = Vec3::Ones();
    }
  }
  for (const LeftOut& each : left_out) warnings.push_back(describe_left_out(each));
  return materials;
}

}  // namespace weft::assets
