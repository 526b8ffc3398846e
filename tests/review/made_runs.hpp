// Folders with files as `weft run` leaves them, the smallest that serve.
#pragma once

#include <fmt/format.h>

#include <string>

#include "review/find_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::review {

class MadeRuns : public support::TestFolder {
 protected:
  void write(const std::string& file, const std::string& content = "-") {
    std::filesystem::create_directories((folder_ / file).parent_path());
    support::write_bytes(folder_ / file, content);
  }

  /// Statistics of a scene called "s" whose output was `output`, with two frames.
  static std::string statistics(const std::string& output, const std::string& more = "") {
    return fmt::format(R"({{"scene": "s", "output": "{}", "fps": 50, {} "frames": [
                          {{"frame": 0, "written": true, "max_strain": 0}},
                          {{"frame": 1, "written": true, "max_strain": 0.0123456789}}]}})",
                       output, more);
  }

  /// Name, file names of video, pictures, statistics and effective scene of each run found: one line each.
  std::string found(const std::filesystem::path& below = "") const {
    std::string text;
    for (const RunFiles& run : find_runs(folder_ / below)) {
      text += run.name + ":";
      for (const auto& file : {run.video, run.stats, run.effective}) {
        if (!file.empty()) text += " " + file.filename().string();
      }
      for (const auto& picture : run.pictures) text += " " + picture.filename().string();
      text += "\n";
    }
    return text;
  }
};

}  // namespace weft::review
