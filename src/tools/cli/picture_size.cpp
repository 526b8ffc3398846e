#include "core/error.hpp"
#include "tools/cli/option_values.hpp"
#include "tools/cli/options.hpp"

namespace weft::cli {
namespace {

constexpr int kMinPictureSide = 16, kMaxPictureSide = 8192;  // same limits as render.width and render.height of a scene

}  // namespace

PictureSize parse_size(const std::string& text) {
  if (const std::size_t cross = text.find('x'); cross != std::string::npos) {
    const auto width = number_in<int>(text.substr(0, cross)), height = number_in<int>(text.substr(cross + 1));
    const auto good = [](int side) { return side >= kMinPictureSide && side <= kMaxPictureSide; };
    if (width && height && good(*width) && good(*height)) return {*width, *height};
  }
  throw Error(ExitCode::usage, "--size: expected WxH in pixels, each from {} to {}, such as 1280x720, got {}",
              kMinPictureSide, kMaxPictureSide, text);
}

}  // namespace weft::cli
