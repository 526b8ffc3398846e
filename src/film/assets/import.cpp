#include "film/assets/import.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/input_file.hpp"
#include "core/json.hpp"
#include "core/nesting.hpp"

namespace weft::assets {
namespace {

/// Opens only regular files, also among those that a file refers to (materials, buffers): pipes and devices may never
/// end. assimp 5.2 passes the names in glTF files on as they are there: percent-encoded.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override { return !find(file).empty(); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    const std::string found = find(file);
    return found.empty() ? nullptr : DefaultIOSystem::Open(found.c_str(), mode);
  }

 private:
  static std::string find(const std::string& file) {
    std::error_code ignored;
    for (const std::string& name : {file, percent_decoded(file)})
      if (std::filesystem::is_regular_file(name, ignored)) return name;
    return {};
  }
};

/// If binary PLY data start with a byte that equals a line feed, assimp 5.2 drops this byte as a part of the header.
/// Returns the bytes of such a file with an additional line feed for assimp to drop; nullopt for all other files.
std::optional<std::string> ply_with_spare_line_feed(const std::filesystem::path& file) {
  constexpr std::size_t kHeaderBytes = 1 << 16;
  constexpr std::string_view kBinary = "\nformat binary_", kEnd = "\nend_header\n";
  std::string bytes = read_start(file, kHeaderBytes);
  const std::size_t data = bytes.find(kEnd) + kEnd.size();
  const bool ply = bytes.starts_with("ply\n") && bytes.find(kBinary) < data;
  if (!ply || data < kEnd.size() || data >= bytes.size() || bytes[data] != '\n') return std::nullopt;
  bytes = read_bytes(file);
  bytes.insert(data, 1, '\n');
  return bytes;
}

/// The bytes of a binary glTF file with an extension such as .vrm, which assimp would read as OBJ; else nullopt.
std::optional<std::string> renamed_gltf(const std::filesystem::path& file) {
  constexpr std::string_view kStart = "glTF";
  if (read_start(file, kStart.size()) != kStart || file.extension() == ".glb") return std::nullopt;
  return read_bytes(file);
}

/// The start of the JSON text of a glTF file; empty for all other files.
std::string gltf_text(const std::filesystem::path& file) {
  constexpr std::size_t kBeginning = 16 << 20;
  // Binary layout: "glTF", version, length; then the length of the JSON text, "JSON", the text.
  constexpr std::size_t kLengthAt = 12, kTextAt = 20;
  std::string bytes = read_start(file, kBeginning);
  if (bytes.starts_with("glTF") && bytes.size() > kTextAt) {
    std::uint32_t length = 0;
    std::memcpy(&length, &bytes[kLengthAt], sizeof length);
    return bytes.substr(kTextAt, length);
  }
  return file.extension() == ".gltf" ? bytes : std::string();
}

/// Name of the compression that a glTF file requires; empty for all other files. The packaged assimp 5.2 does not
/// support compression: it would read compressed data as vertices.
std::string_view compression_of(std::string_view gltf) {
  const std::size_t begin = gltf.find("\"extensionsRequired\"");
  if (begin == std::string_view::npos) return {};
  const std::string_view required = gltf.substr(begin, gltf.find(']', begin) - begin);
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
    if (required.find(name) != std::string_view::npos) return name;
  return {};
}

/// The value of a key; null if there is none.
const nlohmann::json& part_of(const nlohmann::json& json, const char* key) {
  static const nlohmann::json kNone;
  return json.is_object() && json.contains(key) ? json[key] : kNone;
}

/// Name of an attribute of a mesh that glTF has as integers; empty if there is none. assimp 5.2 copies their bytes into
/// its floats. Texture coordinates count only if there are textures.
std::string integer_attribute(const nlohmann::json& gltf) {
  constexpr int kFloat = 5126;
  const nlohmann::json& accessors = part_of(gltf, "accessors");
  for (const nlohmann::json& mesh : part_of(gltf, "meshes"))
    for (const nlohmann::json& primitive : part_of(mesh, "primitives")) {
      const nlohmann::json& attributes = part_of(primitive, "attributes");
      if (!attributes.is_object()) continue;
      for (const auto& [name, accessor] : attributes.items()) {
        const bool read = name == "POSITION" || name.starts_with("WEIGHTS_") ||
                          (name.starts_with("TEXCOORD_") && !part_of(gltf, "textures").empty());
        const int number = value_or<int>(attributes, name.c_str(), -1);
        if (!read || !accessors.is_array() || number < 0 || std::cmp_greater_equal(number, accessors.size())) continue;
        if (value_or<int>(accessors[static_cast<std::size_t>(number)], "componentType", kFloat) != kFloat) return name;
      }
    }
  return {};
}

/// Throws std::runtime_error for glTF with compressed meshes, with attributes that are read wrongly, or JSON that is
/// nested too deeply.
void check_gltf(const std::filesystem::path& file) {
  const std::string text = gltf_text(file);
  if (const std::string_view compression = compression_of(text); !compression.empty())
    throw std::runtime_error("expected meshes without compression, got " + std::string(compression) +
                             ", which is not read; export the file without it");
  if (nests_too_deep(text))
    throw std::runtime_error(
        fmt::format("expected JSON of at most {} levels of lists and objects, got more", kMaxDepth));
  nlohmann::json gltf;
  try {
    if (!text.empty()) gltf = parse_json<nlohmann::json>(text);
  } catch (const std::exception&) {
    return;  // assimp says what is wrong
  }
  if (const std::string name = integer_attribute(gltf); !name.empty())
    throw std::runtime_error("expected " + name + " as floats, got integers, which are not read; export the file " +
                             "without quantisation");
}

}  // namespace

std::string percent_decoded(const std::string& name) {
  std::string decoded;
  for (std::size_t i = 0; i < name.size(); ++i) {
    unsigned char byte = 0;
    const char* end = name.data() + std::min(i + 3, name.size());
    if (name[i] == '%' && std::from_chars(name.data() + i + 1, end, byte, 16).ptr == name.data() + i + 3) {
      decoded += static_cast<char>(byte);
      i += 2;
    } else {
      decoded += name[i];
    }
  }
  return decoded;
}

const aiScene& import(Assimp::Importer& importer, const std::filesystem::path& file, unsigned steps) {
  check_gltf(file);
  importer.SetIOHandler(new RegularFiles);  // owned by the importer
  const aiScene* scene = nullptr;
  if (const auto ply = ply_with_spare_line_feed(file))
    scene = importer.ReadFileFromMemory(ply->data(), ply->size(), steps, "ply");
  else if (const auto gltf = renamed_gltf(file))
    scene = importer.ReadFileFromMemory(gltf->data(), gltf->size(), steps, "glb");
  else
    scene = importer.ReadFile(file.string(), steps);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string_view error = importer.GetErrorString();
    if (error.find("bad_alloc") != std::string_view::npos) throw std::bad_alloc();  // assimp reports it as text only
    throw std::runtime_error(std::string(error));
  }
  return *scene;
}

std::optional<double> metres_per_unit(const aiScene& scene) {
  if (scene.mMetaData == nullptr) return std::nullopt;
  // Assimp 5.2 stores a float, other versions a double.
  float single = 0;
  double centimetres = 0;
  if (scene.mMetaData->Get("UnitScaleFactor", single))
    centimetres = single;
  else if (!scene.mMetaData->Get("UnitScaleFactor", centimetres))
    return std::nullopt;
  if (!std::isfinite(centimetres) || !(centimetres > 0)) return std::nullopt;
  return 0.01 * centimetres;
}

std::optional<int> up_axis(const Assimp::Importer& importer, const aiScene& scene) {
  std::int32_t up = 0;
  if (scene.mMetaData != nullptr && scene.mMetaData->Get("UpAxis", up) && up >= 0 && up <= 2) return up;
  const int reader = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* format = reader < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(reader));
  if (format == nullptr) return std::nullopt;
  const std::string_view endings = format->mFileExtensions;
  constexpr int kY = 1;
  for (const char* says_y : {"gltf", "dae"})
    if (endings.find(says_y) != std::string_view::npos) return kY;
  return std::nullopt;
}

}  // namespace weft::assets
