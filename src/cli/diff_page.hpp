// What weft diff found, as a page to look at.
#pragma once

#include <string>

#include "compare/files.hpp"

namespace weft::cli {

/// One HTML file with all that it shows in it: of each pair that differs the picture before, the one after and where
/// they differ, of videos the worst frame; of the others their names. It runs no scripts.
class DiffPage {
 public:
  /// `description`: of the result.
  void add(const compare::FileComparison& result, const std::string& description);
  /// `title`: how many are as they should be.
  std::string html(const std::string& title) const;

 private:
  void add_figure(const char* kind, const std::string& caption, const image::Image& picture);

  int differing_ = 0;
  std::string sections_, good_;
  std::size_t picture_bytes_ = 0;
};

}  // namespace weft::cli
