#include "film/assets/sequence_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <utility>

#include "core/input_file.hpp"
#include "film/assets/raw_mesh.hpp"
#include "film/assets/source.hpp"

namespace weft::assets {
namespace {

/// Maximum size of the positions of all files [bytes]. A larger size is not practical.
constexpr std::size_t kMaxBytes = std::size_t{8} << 30;

/// The vertex indices of the faces of an OBJ file, as text; empty for other formats. Reads the file without assimp,
/// because assimp makes a separate vertex for each corner.
std::string face_numbers(const std::filesystem::path& file) {
  std::string numbers;
  if (ending_of(file) != ".obj") return numbers;
  std::istringstream in(weft::read_file(file, kMaxMeshFileBytes));
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "f") continue;
    for (std::string corner; words >> corner;) numbers += corner.substr(0, corner.find('/')) + ' ';
    numbers += '\n';
  }
  return numbers;
}

void check_same_faces(const Source& source, const std::filesystem::path& first_file, const RawMesh& first,
                      const RawMesh& other) {
  const auto fail = [&](const char* what, std::size_t expected, std::size_t got) {
    source.fail(fmt::format("expected {} {}, as in the first file of the sequence, got {}", expected, what, got));
  };
  if (other.positions.size() != first.positions.size())
    fail("vertices", first.positions.size(), other.positions.size());
  if (other.quads.size() != first.quads.size()) fail("quads", first.quads.size(), other.quads.size());
  // Compares only the corners of polygons, because their division into triangles depends on their shape, which may
  // change.
  const bool same = other.polygons == first.polygons && other.quads == first.quads &&
                    face_numbers(source.file) == face_numbers(first_file);
  if (!same && other.triangles.size() != first.triangles.size())
    fail("triangles", first.triangles.size(), other.triangles.size());
  if (!same) source.fail("expected faces over the same vertices as in the first file of the sequence, got others");
}

/// Splits groups of coincident vertices if this file has vertices of a group at different positions.
void split_groups(const std::vector<Vec3>& positions, std::vector<Index>& groups) {
  std::map<std::pair<Index, std::array<double, 3>>, Index> known;
  for (std::size_t v = 0; v < groups.size(); ++v) {
    const Vec3 x = positions[v] + Vec3::Zero();  // 0 and -0 are equal
    groups[v] = known.emplace(std::pair(groups[v], std::array{x.x(), x.y(), x.z()}), static_cast<Index>(known.size()))
                    .first->second;
  }
}

std::vector<Vec3> kept_of(const std::vector<Vec3>& positions, const std::vector<Index>& kept) {
  std::vector<Vec3> result;
  for (const Index v : kept) result.push_back(positions[at(v)]);
  return result;
}

}  // namespace

LoadedSequence load_sequence(std::span<const std::filesystem::path> files, const FileAxes& axes,
                             const std::string& where) {
  RawMesh first;
  std::vector<Index> groups;
  LoadedSequence loaded;
  for (const std::filesystem::path& file : files) {
    const Source source{file, where, "mesh"};
    RawMesh raw =
        source.checked([&] { return from_bytes(source.read([&] { return to_bytes(read_raw_mesh(file)); })); });
    const Mat3 turn = axes.scale.value_or(1) * axes.rotation(raw.up);
    for (Vec3& x : raw.positions) {
      x = turn * x;
      source.check_coordinates(x);
    }
    if (loaded.positions.empty()) {
      if (raw.triangles.empty() && raw.quads.empty()) source.fail("expected faces, got none");
      if (raw.positions.size() * sizeof(Vec3) * files.size() > kMaxBytes)
        source.fail(fmt::format("expected at most {} bytes of key frames, got {} of {} vertices", kMaxBytes,
                                files.size(), raw.positions.size()));
      first = raw;
      groups.assign(raw.positions.size(), 0);
    } else {
      check_same_faces(source, files.front(), first, raw);
    }
    split_groups(raw.positions, groups);
    loaded.positions.push_back(std::move(raw.positions));
  }

  const std::vector<Index> kept = join_groups(first, groups);
  for (std::vector<Vec3>& positions : loaded.positions) positions = kept_of(positions, kept);
  first.positions = loaded.positions.front();
  std::size_t flat = 0;
  loaded.mesh.topology = make_topology(first, flat, std::span(loaded.positions).subspan(1));
  loaded.mesh.positions = std::move(first.positions);
  return loaded;
}

}  // namespace weft::assets
