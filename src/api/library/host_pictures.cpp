// Decoding of pictures in the shared library: it calls the function that the program has set with
// set_picture_decoder().
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
  return {picture.width, picture.height, std::move(picture.rgba)};
}

}  // namespace weft
