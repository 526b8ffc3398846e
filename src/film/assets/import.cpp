#include "film/assets/import.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "core/input_file.hpp"
#include "core/nesting.hpp"

namespace weft::assets {
namespace {

/// Opens only regular files, also among those that a file refers to (materials, buffers): pipes and devices may never
/// end.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
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

/// Throws std::runtime_error for glTF with compressed meshes or JSON that is nested too deeply.
void check_gltf(const std::filesystem::path& file) {
  const std::string text = gltf_text(file);
  if (const std::string_view compression = compression_of(text); !compression.empty())
    throw std::runtime_error("expected meshes without compression, got " + std::string(compression) +
                             ", which is not read; export the file without it");
  if (nests_too_deep(text))
    throw std::runtime_error(
        fmt::format("expected JSON of at most {} levels of lists and objects, got more", kMaxDepth));
}

}  // namespace

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
