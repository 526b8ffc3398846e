// A geometry file before it is read: reasons to refuse it, and the time limit for reading it.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>

#include "core/error.hpp"

namespace weft::assets {

/// Maximum file size: larger files are scans, too detailed for collision in every frame.
inline constexpr std::uintmax_t kMaxMeshFileBytes = std::uintmax_t{256} << 20;

/// A file with a coordinate of at least this size counts as damaged [m]: no scene is a thousand kilometres wide.
inline constexpr double kMaxCoordinate = 1e6;

/// A file, and the texts that identify it in messages.
struct Source {
  std::filesystem::path file;
  std::string where;          ///< scene entry that names it, such as "scenes/a.toml:12:8: obstacle.chair"
  std::string kind = "mesh";  ///< "mesh", "character", "motion", "camera"

  /// Throws Error(asset_unreadable) with `where` and the file.
  [[noreturn]] void fail(const std::string& why) const;
  /// The text of fail(), for a warning.
  std::string describe(const std::string& what) const;

  /// Throws for files that are missing, empty, too large, or known to block the reader for ever.
  void check() const;
  /// Calls check(), then `read` in a child process, and returns its result. If the child fails or exceeds its limits of
  /// time and memory, throws like fail() with the reason.
  std::string read(const std::function<std::string()>& read) const;
  /// Returns the result of `work`. Any exception that is not an Error becomes fail(), since it is caused by the file.
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
