#include "cli/whole_output.hpp"

#include <algorithm>

#include "cli/stages.hpp"
#include "core/error.hpp"
#include "image/png.hpp"
#include "video/decoder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

// What pictures say of themselves agrees with what they would say, wherever they were drawn.
bool agrees(const Metadata& found, Metadata expected) {
  expected.erase("gl");
  return std::ranges::all_of(expected, [&](const auto& entry) {
    const auto here = found.find(entry.first);
    return here != found.end() && here->second == entry.second;
  });
}

bool is_whole_video(const fs::path& file, const FrameRange& frames, const render::Settings& settings,
                    Metadata expected) {
  video::Decoder decoder(file);
  expected["frames"] = frames.text();
  // Odd sizes are padded to even ones.
  const bool fits = decoder.width() == settings.width + settings.width % 2 &&
                    decoder.height() == settings.height + settings.height % 2;
  if (!fits || !agrees(decoder.metadata(), std::move(expected))) return false;
  int count = 0;
  while (decoder.next()) ++count;
  return count == frames.count();
}

bool is_whole_picture(const fs::path& file, const render::Settings& settings, const Metadata& expected) {
  Metadata found;
  const image::Image image = image::read_png(file, &found);
  return image.width == settings.width && image.height == settings.height && agrees(found, expected);
}

}  // namespace

bool is_whole(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
              const cache::Manifest& scene, const fs::path& meshes, const std::vector<std::string>& objects) {
  const auto exists = [](const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
  };
  const std::vector<fs::path> files = target.files(frames);
  if (!std::ranges::all_of(files, exists)) return false;
  if (!meshes.empty())
    for (const std::string& object : objects)
      if (!std::ranges::all_of(mesh_files(meshes, object).names(frames), exists)) return false;
  const Metadata expected = describe_pictures(scene, settings, "");
  try {
    if (target.kind == OutputTarget::Kind::video) return is_whole_video(files[0], frames, settings, expected);
    return std::ranges::all_of(files, [&](const fs::path& file) { return is_whole_picture(file, settings, expected); });
  } catch (const Error&) {
    return false;  // what cannot be read is not whole
  }
}

}  // namespace weft::cli
