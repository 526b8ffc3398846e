#include "assets/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <fstream>
#include <numeric>
#include <system_error>
#include <utility>
#include <vector>

#include "assets/isolated.hpp"
#include "assets/soup.hpp"
#include "core/error.hpp"
#include "mesh/geometry.hpp"
#include "mesh/quads.hpp"

namespace weft::assets {
namespace {

/// Faces flatter than this (area by longest side squared) count as having no area: their normal is rounding noise of
/// the single precision that assimp reads with.
constexpr double kFlatFace = 1e-7;

/// Everything a message needs.
struct Source {
  const std::filesystem::path& file;
  const std::string& where;

  [[noreturn]] void fail(const std::string& why) const {
    throw Error(ExitCode::asset_unreadable, "{}: mesh file {}: {}", where, file.string(), why);
  }
};

/// Returns the size of the file [bytes].
std::uintmax_t check_size(const Source& source) {
  std::error_code error;
  const auto status = std::filesystem::status(source.file, error);
  if (!std::filesystem::exists(status)) source.fail("expected a readable file, got none at this path");
  if (!std::filesystem::is_regular_file(status)) source.fail("expected a regular file, got a folder or a device");
  const std::uintmax_t bytes = std::filesystem::file_size(source.file, error);
  if (error) source.fail(error.message());
  if (bytes == 0) source.fail("expected a mesh, got an empty file");
  if (bytes > kMaxMeshFileBytes) {
    source.fail(fmt::format("expected at most {} bytes, got {}; reduce the mesh", kMaxMeshFileBytes, bytes));
  }
  return bytes;
}

/// A PLY header without end keeps assimp 5.2 busy for ever; refusing it here spares the user the wait for the time
/// limit.
void check_ply_header(const Source& source) {
  constexpr std::size_t kHeaderBytes = 1 << 16;  // of which real headers take a hundredth
  std::ifstream in(source.file, std::ios::binary);
  std::string start(kHeaderBytes, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(in.gcount()));
  const bool ply = start.starts_with("ply") || start.starts_with("PLY");
  if (ply && start.find("\nend_header\n") == std::string::npos && start.find("\nend_header\r") == std::string::npos)
    source.fail("expected a line end_header in the first 64 kB of a PLY file, got none");
}

/// Processor time that reading may take [s]: many times what assimp needs for its slowest text formats (about 10 MB/s),
/// so that only files which keep it busy for ever are stopped.
unsigned time_limit(std::uintmax_t bytes) {
  return 5 + static_cast<unsigned>(bytes >> 20);
}

Soup read(const Source& source, std::uintmax_t bytes) {
  try {
    return from_bytes(run_isolated([&] { return to_bytes(read_soup(source.file)); }, time_limit(bytes)));
  } catch (const std::exception& error) {
    source.fail(error.what());
  }
}

/// For each vertex the first one at exactly the same place.
std::vector<Index> first_at_same_place(const std::vector<Vec3>& positions) {
  const auto key = [&](Index i) {
    const Vec3& x = positions[static_cast<std::size_t>(i)];
    return std::array{x.x(), x.y(), x.z()};
  };
  std::vector<Index> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<Index> first(positions.size());
  Index start = -1;  // of the run of equal positions
  for (const Index i : order) {
    if (start < 0 || key(i) != key(start)) start = i;
    first[static_cast<std::size_t>(i)] = start;
  }
  return first;
}

/// Joins vertices at exactly the same place (0 and -0 are one) and drops those that no face names. Vertices come in the
/// order in which faces first name them. Returns the number of copies joined to others.
std::size_t join_vertices(Soup& soup) {
  const std::vector<Index> first = first_at_same_place(soup.positions);
  std::vector<Index> renamed(first.size(), -1);
  std::vector<Vec3> kept;
  const auto rename = [&](Index& v) {
    const auto representative = static_cast<std::size_t>(first[static_cast<std::size_t>(v)]);
    if (renamed[representative] < 0) {
      renamed[representative] = static_cast<Index>(kept.size());
      kept.push_back(soup.positions[representative]);
    }
    v = renamed[representative];
  };
  for (auto& q : soup.quads) std::for_each(q.begin(), q.end(), rename);
  for (auto& t : soup.triangles) std::for_each(t.begin(), t.end(), rename);
  soup.positions = std::move(kept);
  std::size_t joined = 0;
  for (std::size_t v = 0; v < first.size(); ++v) joined += first[v] == static_cast<Index>(v) ? 0 : 1;
  return joined;
}

bool has_area(const mesh::Triangle& t, const std::vector<Vec3>& x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[static_cast<std::size_t>(t[k])]; };
  const double longest_sq = std::max({(corner(1) - corner(0)).squaredNorm(), (corner(2) - corner(1)).squaredNorm(),
                                      (corner(0) - corner(2)).squaredNorm()});
  return mesh::area_vector(t, x).norm() > kFlatFace * longest_sq;
}

}  // namespace

LoadedMesh load_mesh(const std::filesystem::path& file, double scale, const std::string& where) {
  const Source source{file, where};
  const std::uintmax_t bytes = check_size(source);
  check_ply_header(source);
  Soup soup = read(source, bytes);
  if (soup.triangles.empty() && soup.quads.empty()) source.fail("expected faces, got none");
  for (Vec3& x : soup.positions) {
    x *= scale;
    // Squares of lengths and their products must stay finite too.
    if (!(x.cwiseAbs().maxCoeff() < kMaxCoordinate))
      source.fail(fmt::format("expected coordinates below {:g} m, got ({:g}, {:g}, {:g})", kMaxCoordinate, x.x(), x.y(),
                              x.z()));
  }

  LoadedMesh result;
  result.joined_vertices = join_vertices(soup);
  std::vector<mesh::Triangle> triangles = mesh::split_quads(soup.quads, soup.positions);
  const auto flat = [&](const mesh::Triangle& t) { return !has_area(t, soup.positions); };
  if (soup.triangles.empty() && std::none_of(triangles.begin(), triangles.end(), flat)) {
    result.mesh.topology.quads = std::move(soup.quads);
  } else {
    triangles.insert(triangles.end(), soup.triangles.begin(), soup.triangles.end());
    result.removed_triangles = std::erase_if(triangles, flat);
  }
  if (triangles.empty()) source.fail("expected faces with an area, got none");
  result.mesh.topology.triangles = std::move(triangles);
  result.mesh.positions = std::move(soup.positions);
  return result;
}

}  // namespace weft::assets
