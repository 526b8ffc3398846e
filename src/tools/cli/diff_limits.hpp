// Limits of `weft diff` for single pictures, read from a file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/compare/compare.hpp"

namespace weft::cli {

class DiffLimits {
 public:
  /// The limits and mask of one picture.
  struct Rules {
    compare::Limits limits;
    std::filesystem::path mask;  ///< a picture; white pixels are compared; empty: all are compared
  };

  /// `all`: the limits of every picture. `file`: empty, or TOML with tables [[picture]], each with a name (wildcards *
  /// and ?) and the limits or the mask that differ for it; mask paths are relative to the file. Throws
  /// Error(asset_unreadable) with line and column.
  DiffLimits(const compare::Limits& all, const std::filesystem::path& file);

  /// The rules of a picture; later tables take precedence over earlier ones.
  Rules of(const std::string& name) const;
  /// Throws Error(asset_unreadable) with line and column if a table matches none of these pictures: its limits would
  /// have no effect, and nobody would notice.
  void check_used(const std::vector<std::string>& names) const;

 private:
  struct Entry {
    bool fits(const std::string& name) const;

    std::string pattern;
    std::string place;  // for example "limits.toml:3:1"
    std::vector<std::function<void(Rules&)>> changes;
  };
  Rules all_;
  std::vector<Entry> entries_;
};

}  // namespace weft::cli
