// The result of `weft diff` as an HTML page.
#pragma once

#include <string>

#include "tools/compare/files.hpp"

namespace weft::cli {

/// One self-contained HTML file without scripts. Of each pair that differs or lacks a readable file, it shows reference
/// ("before"), test ("after") and, if they were compared, a map of the differences; of videos the worst frame. Beyond
/// about 100 MB, it shows no pictures. Other pairs are only listed.
class DiffPage {
 public:
  /// `description`: the result as a line, which begins with "NAME: ".
  void add(const compare::FileComparison& result, const std::string& description);
  /// `title`: how many pairs are within their limits.
  std::string html(const std::string& title) const;

 private:
  void add_figure(const char* kind, const std::string& caption, const image::Image& picture);

  int differing_ = 0;
  std::string sections_, good_;
  std::size_t picture_bytes_ = 0;
};

}  // namespace weft::cli
