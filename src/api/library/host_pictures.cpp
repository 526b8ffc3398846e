// Decoding of pictures in the shared library: it calls the function that the program has set with
// set_picture_decoder().
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <weft/pictures.hpp>

#include "film/image/picture.hpp"

namespace weft {
namespace {

std::function<Picture(std::string_view)>& host_decoder() {
  static std::function<Picture(std::string_view)> decode;
  return decode;
}

}  // namespace

void set_picture_decoder(std::function<Picture(std::string_view bytes)> decode) {
  host_decoder() = std::move(decode);
}

image::Picture image::decode_picture(std::string_view bytes) {
  if (!host_decoder()) throw std::runtime_error("the library decodes no pictures; give it set_picture_decoder()");
  weft::Picture picture = host_decoder()(bytes);
  const bool has_size =
      std::min(picture.width, picture.height) > 0 && std::max(picture.width, picture.height) <= kMaxPictureSide;
  if (!has_size || picture.rgba.size() != std::size_t{4} * static_cast<std::size_t>(picture.width) *
                                              static_cast<std::size_t>(picture.height))
    throw std::runtime_error(fmt::format(
        "expected 4 bytes for each pixel, and sides from 1 to {} pixels, got {} bytes for {} x {} pixels from the "
        "decoder of set_picture_decoder()",
        kMaxPictureSide, picture.rgba.size(), picture.width, picture.height));
  return {picture.width, picture.height, std::move(picture.rgba)};
}

}  // namespace weft
