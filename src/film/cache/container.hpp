// Container format of all binary files of a frame cache; README.md has its layout. The first bytes reveal that a
// program has converted line ends.
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
