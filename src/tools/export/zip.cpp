#include "tools/export/zip.hpp"

extern "C" {
#include <libavutil/crc.h>
}

#include <cstdint>
#include <limits>

#include "core/error.hpp"
#include "core/temporary_file.hpp"

namespace weft::exporter {
namespace {

constexpr std::size_t kLocalHeader = 30, kAlignment = 64;  // [bytes]
constexpr std::uint16_t kVersion = 10;                     // 1.0: uncompressed files
constexpr std::uint16_t kUtf8Names = 0x0800;
constexpr std::uint16_t kFirstDay = 0x0021;  // 1980-01-01, the earliest date
constexpr std::uint16_t kPaddingId = 0x1986;

// Appends the lowest `size` bytes of a number, little endian; if `size` exceeds 8, the remaining bytes are 0.
void append(std::string& bytes, std::uint64_t number, int size) {
  for (int i = 0; i < size; ++i, number >>= 8) bytes += static_cast<char>(number & 0xff);
}

std::uint32_t crc32(const std::string& bytes) {
  constexpr std::uint32_t kAllBits = 0xffffffffU;
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return ~av_crc(av_crc_get_table(AV_CRC_32_IEEE_LE), kAllBits, data, bytes.size());
}

// Fields that the local header of a file and its entry in the directory share.
std::string entry_of(const StoredFile& file) {
  std::string entry;
  append(entry, kVersion, 2);
  append(entry, kUtf8Names, 2);
  append(entry, 0, 2);  // uncompressed
  append(entry, 0, 2);  // time of day
  append(entry, kFirstDay, 2);
  append(entry, crc32(file.content), 4);
  append(entry, file.content.size(), 4);
  append(entry, file.content.size(), 4);
  append(entry, file.name.size(), 2);
  return entry;
}

void append_file(std::string& bytes, const StoredFile& file, const std::string& entry) {
  // An extra field pads the header so that the content is aligned. The field has at least four
  // bytes, its own header.
  std::size_t padding = (kAlignment - (bytes.size() + kLocalHeader + file.name.size()) % kAlignment) % kAlignment;
  if (padding > 0 && padding < 4) padding += kAlignment;
  bytes += "PK\x03\x04" + entry;
  append(bytes, padding, 2);
  bytes += file.name;
  if (padding > 0) {
    append(bytes, kPaddingId, 2);
    append(bytes, padding - 4, 2);
    bytes.append(padding - 4, '\0');
  }
  bytes += file.content;
}

}  // namespace

void write_stored(const std::filesystem::path& file, const std::vector<StoredFile>& files) {
  std::size_t size = 0;
  for (const StoredFile& stored : files) size += stored.content.size() + 4096;
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw Error(ExitCode::output_failed,
                "{}: packed files end at 4 GiB, and this would be one of {:.3g} GB; export fewer frames with --frames, "
                "or as usd",
                file.string(), 1e-9 * static_cast<double>(size));
  std::string bytes, directory;
  for (const StoredFile& stored : files) {
    const std::size_t start = bytes.size();
    const std::string entry = entry_of(stored);
    append_file(bytes, stored, entry);
    directory += "PK\x01\x02";
    append(directory, kVersion, 2);
    directory += entry;
    append(directory, 0, 2 + 2 + 2 + 2 + 4);  // extra field, comment, disk, attributes
    append(directory, start, 4);
    directory += stored.name;
  }
  const std::size_t end = bytes.size();
  bytes += directory;
  bytes += "PK\x05\x06";
  append(bytes, 0, 2 + 2);  // disks
  append(bytes, files.size(), 2);
  append(bytes, files.size(), 2);
  append(bytes, directory.size(), 4);
  append(bytes, end, 4);
  append(bytes, 0, 2);  // comment
  write_file(file, bytes, Flush::no);
}

}  // namespace weft::exporter
