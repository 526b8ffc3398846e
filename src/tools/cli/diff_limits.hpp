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
    std::filesystem::path mask;  ///< picture file; only its white pixels are compared; empty: all pixels are
  };

  /// `all`: the limits of all pictures, unless `file` changes them. `file`: TOML with tables
  /// [[picture]]. Each table has a name (with wildcards * and ?), and limits and a mask for the
  /// pictures that match; paths of masks are relative to the folder of `file`. If `file` is empty,
  /// the limits `all` hold for all pictures. Throws Error(asset_unreadable); for a mistake in the
  /// file, with line and column.
  DiffLimits(const compare::Limits& all, const std::filesystem::path& file);

  /// The rules of a picture. If several tables match, later tables take precedence.
  Rules of(const std::string& name) const;
  /// Throws Error(asset_unreadable) with line and column if a table matches none of `names`, since
  /// its limits would have no effect.
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
