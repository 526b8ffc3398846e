#include <charconv>

#include "core/error.hpp"
#include "tools/cli/options.hpp"

namespace weft::cli {
namespace {

constexpr int kMinPictureSide = 16, kMaxPictureSide = 8192;  // same limits as render.width and render.height of a scene

}  // namespace

PictureSize parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  PictureSize size;
  if (cross != std::string::npos) {
    const char *begin = text.data(), *middle = begin + cross, *end = begin + text.size();
    const auto width = std::from_chars(begin, middle, size.width);
    const auto height = std::from_chars(middle + 1, end, size.height);
    const bool whole = width.ec == std::errc() && width.ptr == middle && height.ec == std::errc() && height.ptr == end;
    const auto good = [](int side) { return side >= kMinPictureSide && side <= kMaxPictureSide; };
    if (whole && good(size.width) && good(size.height)) return size;
  }
  throw Error(ExitCode::usage, "--size: expected WxH in pixels, each from {} to {}, such as 1280x720, got {}",
              kMinPictureSide, kMaxPictureSide, text);
}

}  // namespace weft::cli
