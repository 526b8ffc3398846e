// Container format of all binary files of a frame cache. Little endian:
//
//   offset  size  content
//        0     8  89 57 45 46 54 0D 0A 1A ("\x89WEFT\r\n\x1A": reveals line-end conversions)
//        8     4  format version, kFormatVersion
//       12     4  kind: 1 surfaces, 2 frame, 3 state
//       16     4  frame number, signed (0 for surfaces; negative for the state of a preroll)
//       20     4  reserved, 0
//       24     8  scene hash
//       32     8  size of the payload
//       40     8  size of the payload as stored
//       48     8  XXH3 (64 bits) of bytes 0 to 47 and of the stored payload
//       56     -  the payload, one frame of Zstandard (RFC 8878)
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace weft::cache {

inline constexpr std::uint32_t kFormatVersion = 19;

enum class Kind : std::uint32_t { surfaces = 1, frame = 2, state = 3 };

/// The identity of a file.
struct Label {
  Kind kind = Kind::surfaces;
  std::int32_t frame = 0;  ///< number; 0 for surfaces; < 0: state of a preroll
  std::uint64_t scene_hash = 0;
};

struct Content {
  Label label;
  std::string payload;
};

/// The bytes of a file: the header and the compressed payload.
std::string pack(const Label& label, std::string_view payload);

/// Decompresses a payload. Checks what verify() checks, and the size of the payload. Does not compare the label, and
/// does not check the content of the payload. Throws std::runtime_error that describes the defect.
Content unpack(std::string_view bytes);

/// Checks magic bytes, version, stored size and checksum without decompressing. Throws std::runtime_error that
/// describes the defect.
Label verify(std::string_view bytes);

}  // namespace weft::cache
