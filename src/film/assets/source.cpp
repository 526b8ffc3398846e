#include "film/assets/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <string>
#include <system_error>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/isolated.hpp"

namespace weft::assets {
namespace {

constexpr std::uint64_t kMaxAddressSpace = std::uint64_t{16} << 30;  // limit for the child process [bytes]

/// Refuses two kinds of PLY files: those whose header has no end, because they block assimp 5.2 until the time limit;
/// and those with triangle strips, because assimp reads only one triangle of each strip.
void check_ply_header(const Source& source) {
  constexpr std::size_t kHeaderBytes = 1 << 16;  // a hundred times the size of usual headers
  const std::string start = read_start(source.file, kHeaderBytes);
  const bool ply = start.starts_with("ply") || start.starts_with("PLY");
  if (!ply) return;
  const std::size_t end = std::min(start.find("\nend_header\n"), start.find("\nend_header\r"));
  if (end == std::string::npos) source.fail("expected a line end_header in the first 64 kB of a PLY file, got none");
  if (start.find("\nelement tristrips ") < end)
    source.fail("expected faces, got triangle strips (tristrips), which are not read; export the file with faces");
}

/// CPU time limit for reading [s]. It is many times what assimp needs for its slowest text formats (about 10 MB/s), so
/// that only files that block assimp for ever exceed it. `bytes`: size of the file.
unsigned time_limit(std::uintmax_t bytes) {
  return 5 + static_cast<unsigned>(bytes >> 20);
}

/// Wall time limit, relative to the CPU time limit. It is large, because many processes may share a machine.
constexpr unsigned kWallFactor = 20;

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::string ending_of(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

void Source::fail(const std::string& why) const {
  throw Error(ExitCode::asset_unreadable, describe(why));
}

std::string Source::describe(const std::string& what) const {
  return fmt::format("{}: {} file {}: {}", where, kind, file.string(), what);
}

void Source::check_coordinates(const Vec3& x) const {
  if (!(x.cwiseAbs().maxCoeff() < kMaxCoordinate))
    fail(fmt::format("expected coordinates below {:g} m, got ({:g}, {:g}, {:g})", kMaxCoordinate, x.x(), x.y(), x.z()));
}

void Source::check() const {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail("expected a readable file, got none at this path");
  if (!std::filesystem::is_regular_file(status)) fail("expected a regular file, got a folder or a device");
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) fail(error.message());
  if (bytes == 0) fail(fmt::format("expected a {}, got an empty file", kind));
  if (bytes > kMaxMeshFileBytes)
    fail(fmt::format("expected at most {} bytes, got {}; reduce the mesh", kMaxMeshFileBytes, bytes));
  check_ply_header(*this);
}

std::string Source::read(const std::function<std::string()>& read) const {
  check();
  try {
    const unsigned seconds = time_limit(std::filesystem::file_size(file));
    return run_isolated(read, {.name = "the reader",
                               .cpu_seconds = seconds,
                               .wall_seconds = kWallFactor * seconds,
                               .max_address_space = kMaxAddressSpace});
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

}  // namespace weft::assets
