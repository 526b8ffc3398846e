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
  /// `all`: of every picture. `file` may be empty; else TOML with tables [[picture]]: a name, in which * and ? stand
  /// for other characters, and what of the limits is another for it. Throws Error(asset_unreadable) with line and
  /// column.
  DiffLimits(const compare::Limits& all, const std::filesystem::path& file);

  /// Later tables count before earlier ones.
  compare::Limits of(const std::string& name) const;

 private:
  struct Entry {
    std::string pattern;
    std::vector<std::function<void(compare::Limits&)>> changes;
  };
  compare::Limits all_;
  std::vector<Entry> entries_;
};

}  // namespace weft::cli
