#include "film/image/picture.hpp"

#include "core/input_file.hpp"

namespace weft::image {

bool is_targa(std::string_view bytes) {
  constexpr std::size_t kHeader = 18;
  if (bytes.size() <= kHeader) return false;
  const auto at = [&](std::size_t k) { return static_cast<unsigned char>(bytes[k]); };
  const unsigned kind = at(2) & 7U, depth = at(16);  // & 7 removes the bit for run-length encoding
  const bool known = at(1) <= 1 && (at(2) & ~8U) == kind && kind >= 1 && kind <= 3;
  return known && (depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32) && (at(17) & 0xc0U) == 0 &&
         (at(12) | at(13)) != 0 && (at(14) | at(15)) != 0;
}

Picture read_picture(const std::filesystem::path& file) {
  return read_checked(file, [&] { return decode_picture(read_bytes(file, kMaxPictureBytes)); });
}

}  // namespace weft::image
