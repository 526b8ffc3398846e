#include "film/assets/import.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
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
#include "film/assets/gltf_file.hpp"
#include "film/assets/text_file.hpp"

namespace weft::assets {
namespace {

/// Opens files for assimp, also files to which a file refers (materials, buffers). Opens only regular files, because
/// reading pipes and devices may never end. Also tries decoded names, because assimp 5.2 does not decode the
/// percent-encoded names in glTF files.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override { return !find(file).empty(); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    const std::string found = find(file);
    if (found.empty()) return nullptr;
    const std::optional<std::string> text = readable_text(found);
    if (!text) return DefaultIOSystem::Open(found.c_str(), mode);
    auto* bytes = new std::uint8_t[text->size()];
    std::ranges::copy(*text, bytes);
    return new Assimp::MemoryIOStream(bytes, text->size(), true);  // the stream owns the bytes
  }

 private:
  static std::string find(const std::string& file) {
    std::error_code ignored;
    for (const std::string& name : {file, percent_decode(file)})
      if (std::filesystem::is_regular_file(name, ignored)) return name;
    return {};
  }
};

/// The bytes that assimp 5.2 shall read instead of a PLY file; nullopt if it can read the file itself. Two kinds of
/// files need this:
/// - If comments are before the line `format`, assimp refuses the file. They are removed.
/// - If the first byte of binary data is that of a line feed, assimp reads it as a part of the header. It becomes two.
std::optional<std::string> readable_ply(const std::filesystem::path& file) {
  constexpr std::size_t kHeaderBytes = 1 << 16;
  constexpr std::string_view kFormat = "\nformat ", kBinary = "\nformat binary_", kEnd = "\nend_header\n";
  const std::string start = read_start(file, kHeaderBytes);
  if (!start.starts_with("ply\n") && !start.starts_with("ply\r\n")) return std::nullopt;
  const std::size_t line_end = start.find('\n'), format = start.find(kFormat), data = start.find(kEnd) + kEnd.size();
  const bool has_comments = format != std::string::npos && format > line_end;
  const bool loses_byte =
      start.find(kBinary) < data && data >= kEnd.size() && data < start.size() && start[data] == '\n';
  if (!has_comments && !loses_byte) return std::nullopt;
  std::string bytes = read_bytes(file);
  if (loses_byte) bytes.insert(data, 1, '\n');
  if (has_comments) bytes.erase(line_end, format - line_end);
  return bytes;
}

}  // namespace

std::string percent_decode(const std::string& name) {
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
  importer.SetIOHandler(new RegularFiles);  // owned by the importer
  const aiScene* scene = nullptr;
  if (const auto ply = readable_ply(file))
    scene = importer.ReadFileFromMemory(ply->data(), ply->size(), steps, "ply");
  else if (const auto gltf = readable_gltf(file))
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

std::set<std::string> names_of_mesh(const aiScene& scene, const aiNode& node, unsigned k) {
  const std::string mesh = scene.mMeshes[node.mMeshes[k]]->mName.C_Str(), number = fmt::format("-{}", k);
  std::set<std::string> names{node.mName.C_Str(), mesh};
  if (node.mNumMeshes > 1 && mesh.ends_with(number)) names.insert(mesh.substr(0, mesh.size() - number.size()));
  return names;
}

std::optional<double> metres_per_unit(const aiScene& scene) {
  if (scene.mMetaData == nullptr) return std::nullopt;
  // assimp 5.2 stores a float, other versions a double.
  float single = 0;
  double centimetres = 0;
  if (scene.mMetaData->Get("UnitScaleFactor", single))
    centimetres = single;
  else if (!scene.mMetaData->Get("UnitScaleFactor", centimetres))
    return std::nullopt;
  if (!std::isfinite(centimetres) || !(centimetres > 0)) return std::nullopt;
  return 0.01 * centimetres;
}

double rest_weight(const aiScene& scene, const aiAnimMesh& target) {
  return metres_per_unit(scene) && target.mWeight == 1 ? 0 : static_cast<double>(target.mWeight);
}

std::optional<int> up_axis(const Assimp::Importer& importer, const aiScene& scene) {
  std::int32_t up = 0;
  if (scene.mMetaData != nullptr && scene.mMetaData->Get("UpAxis", up) && up >= 0 && up <= 2) return up;
  const int reader = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* format = reader < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(reader));
  if (format == nullptr) return std::nullopt;
  const std::string_view endings = format->mFileExtensions;
  constexpr int kY = 1;
  for (const char* y_up_format : {"gltf", "dae"})
    if (endings.find(y_up_format) != std::string_view::npos) return kY;
  return std::nullopt;
}

}  // namespace weft::assets
