// Checks files before they are read, and reads them in a child process with a time limit.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/types.hpp"

namespace weft::assets {

/// Maximum file size [bytes]. Larger files usually are 3D scans, whose meshes are too fine for collision.
inline constexpr std::uintmax_t kMaxMeshFileBytes = std::uintmax_t{256} << 20;

/// Limit of coordinates [m]. A file with a larger coordinate counts as damaged: no scene is a thousand kilometres wide.
inline constexpr double kMaxCoordinate = 1e6;

/// The text with ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The ending of a file name in lower case, with its dot; empty if there is none.
std::string ending_of(const std::filesystem::path& file);

/// A file, and the texts that name it in messages.
struct Source {
  std::filesystem::path file;
  std::string where;          ///< scene entry that names it, such as "scenes/a.toml:12:8: obstacle.chair"
  std::string kind = "mesh";  ///< "mesh", "character", "motion", "camera"

  /// Throws Error(asset_unreadable) with `where` and the file.
  [[noreturn]] void fail(const std::string& why) const;
  /// The text that fail() throws; also used for warnings.
  std::string describe(const std::string& what) const;

  /// Throws like fail() if a coordinate of `x` is not below kMaxCoordinate.
  void check_coordinates(const Vec3& x) const;

  /// Throws like fail() if the file is missing, no regular file, empty, larger than kMaxMeshFileBytes, or a PLY file
  /// that assimp misreads or that blocks assimp for ever.
  void check() const;
  /// Calls check(), then `read` in a child process, and returns its result. If the child fails or exceeds its limits on
  /// time and memory, throws like fail() with the reason.
  std::string read(const std::function<std::string()>& read) const;
  /// Returns the result of `work`. If `work` throws an exception other than Error, calls fail() with its message,
  /// because the file is the cause.
  template <class Work>
  auto checked(const Work& work) const {
    try {
      return work();
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }
};

}  // namespace weft::assets
