// Limits of single pictures, from a file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "compare/compare.hpp"

namespace weft::cli {

class DiffLimits {
 public:
  /// What a picture is held against.
  struct Rules {
    compare::Limits limits;
    std::filesystem::path mask;  ///< a picture, white where is compared; empty: everywhere
  };

  /// `all`: of every picture. `file` may be empty; else TOML with tables [[picture]]: a name, in which * and ? stand
  /// for other characters, and what of the limits is another for it, or its mask, beside the file. Throws
  /// Error(asset_unreadable) with line and column.
  DiffLimits(const compare::Limits& all, const std::filesystem::path& file);

  /// Later tables count before earlier ones.
  Rules of(const std::string& name) const;
  /// Throws Error(asset_unreadable) with line and column where a table fits none of these pictures: its limit would
  /// hold nothing without a word.
  void check_used(const std::vector<std::string>& names) const;

 private:
  struct Entry {
    bool fits(const std::string& name) const;

    std::string pattern;
    std::string place;  // "limits.toml:3:1"
    std::vector<std::function<void(Rules&)>> changes;
  };
  Rules all_;
  std::vector<Entry> entries_;
};

}  // namespace weft::cli
