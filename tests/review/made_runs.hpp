// Folders with files as `weft run` writes them, as small as possible.
#pragma once

#include <fmt/format.h>

#include <string>

#include "film/image/png.hpp"
#include "film/video/encoder.hpp"
#include "support/test_folder.hpp"
#include "tools/review/find_runs.hpp"

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

  /// A black picture with a grey square, which moves to the right by two pixels per frame.
  static image::Image picture(int frame, int gray = 200, int width = 64) {
    image::Image image(width, 36);
    for (int y = 12; y < 24; ++y) {
      for (int x = 2 * frame; x < std::min(2 * frame + 12, width); ++x) {
        for (int channel = 0; channel < 3; ++channel) image.pixel(x, y)[channel] = static_cast<std::uint8_t>(gray);
      }
    }
    return image;
  }

  void write_video(const std::string& file, int frames, int gray = 200, int width = 64, double fps = 50) {
    video::Settings settings;
    settings.width = width;
    settings.height = 36;
    settings.fps = fps;
    video::Encoder encoder(folder_ / file, settings);
    for (int frame = 0; frame < frames; ++frame) encoder.add(picture(frame, gray, width));
    encoder.finish();
  }

  /// One line for each run that is found: its name and the file names of video, statistics, effective scene and
  /// pictures.
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
