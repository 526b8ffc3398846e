// The result of `weft diff` as an HTML page.
#pragma once

#include <string>

#include "tools/compare/files.hpp"

namespace weft::cli {

/// Makes one self-contained HTML file without scripts. For each pair that is not within its limits, or of which a file
/// is missing or unreadable, the page shows the reference ("before"), the test ("after") and, if the files were
/// compared, the FLIP map of their difference; for videos, the pictures of the worst frame. After about 100 MB of
/// pictures, the page shows further pairs without pictures. Pairs within their limits are only listed.
class DiffPage {
 public:
  /// `description`: the result in one line that begins with its name and ": ", as describe() (diff_report.hpp) makes
  /// it.
  void add(const compare::FileComparison& result, const std::string& description);
  /// `title`: a sentence with the number of pairs within their limits.
  std::string html(const std::string& title) const;

 private:
  void add_figure(const char* kind, const std::string& caption, const image::Image& picture);

  int differing_ = 0;
  std::string sections_, good_;
  std::size_t picture_bytes_ = 0;
};

}  // namespace weft::cli
