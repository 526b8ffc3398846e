// A file of geometry before it is read: what is refused without reading it, and how long reading may take.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>

#include "core/error.hpp"

namespace weft::assets {

/// Larger files are refused: they would be scans, far beyond what cloth can collide with frame by frame.
inline constexpr std::uintmax_t kMaxMeshFileBytes = std::uintmax_t{256} << 20;

/// Coordinates from here on are taken for damage [m]: no scene is a thousand kilometres wide.
inline constexpr double kMaxCoordinate = 1e6;

/// A file and everything that a message about it needs.
struct Source {
  std::filesystem::path file;
  std::string where;          ///< what refers to it, such as "scenes/a.toml:12:8: obstacle.chair"
  std::string kind = "mesh";  ///< "mesh", "character", "motion"

  /// Throws Error(asset_unreadable) with `where` and the file.
  [[noreturn]] void fail(const std::string& why) const;
  /// The same words, for a warning.
  std::string describe(const std::string& what) const;

  /// Throws for files that are missing, empty, too large, or known to keep the reader busy for ever.
  void check() const;
  /// Calls `read` in a process of its own and returns its bytes; throws as fail() does with its reason.
  std::string read(const std::function<std::string()>& read) const;
  /// Returns what `work` returns; what it throws that is no Error becomes fail(): whatever a file holds, it is the
  /// mistake of the file.
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
