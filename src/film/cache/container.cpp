#include "film/cache/container.hpp"

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <stdexcept>

#include "core/archive.hpp"
#include "film/cache/names.hpp"

namespace weft::cache {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(std::size_t) == 8,
              "plain values are written as they are in memory");

constexpr std::size_t kCheckedSize = 48, kHeaderSize = 56;  // [bytes]; README.md has the layout
// Compression level of Zstandard. The last mantissa bits of positions do not compress at any level; levels from 3 on
// take longer and give no smaller files.
constexpr int kLevel = 1;
// A block of Zstandard holds at most 128 KiB and takes at least 4 bytes. Only damaged files claim a higher ratio.
constexpr std::uint64_t kMaxCompressionRatio = 32768;

struct Header {
  char magic[8] = {};
  std::uint32_t version = kFormatVersion;
  Label label;
  std::uint32_t reserved = 0;
  std::uint64_t size = 0, stored_size = 0, checksum = 0;
};

template <class Archive>
void serialize(Archive& archive, Header& header) {
  archive.value(header.magic);
  archive.value(header.version);
  archive.value(header.label.kind);
  archive.value(header.label.frame);
  archive.value(header.reserved);
  archive.value(header.label.scene_hash);
  archive.value(header.size);
  archive.value(header.stored_size);
  archive.value(header.checksum);
}

std::uint64_t checksum_of(std::string_view header, std::string_view stored) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  XXH3_64bits_update(state.get(), header.data(), kCheckedSize);
  XXH3_64bits_update(state.get(), stored.data(), stored.size());
  return XXH3_64bits_digest(state.get());
}

Header check(std::string_view bytes) {
  if (bytes.size() < kHeaderSize) throw std::runtime_error("it was cut short");
  if (!bytes.starts_with(kMagic)) throw std::runtime_error("it is no file of a frame cache");
  ByteReader reader{bytes};
  Header header;
  serialize(reader, header);
  if (header.version != kFormatVersion)
    throw std::runtime_error(
        fmt::format("made by another version of Weft (format {}; this one reads {})", header.version, kFormatVersion));
  if (header.stored_size > reader.bytes.size()) throw std::runtime_error("it was cut short");
  if (header.stored_size < reader.bytes.size()) throw std::runtime_error("there is something behind its end");
  if (header.checksum != checksum_of(bytes, reader.bytes)) throw std::runtime_error("its checksum is wrong");
  return header;
}

}  // namespace

std::string pack(const Label& label, std::string_view payload) {
  std::string stored(ZSTD_compressBound(payload.size()), '\0');
  const std::size_t size = ZSTD_compress(stored.data(), stored.size(), payload.data(), payload.size(), kLevel);
  if (ZSTD_isError(size)) throw std::runtime_error(fmt::format("Zstandard: {}", ZSTD_getErrorName(size)));
  stored.resize(size);
  Header header;
  std::copy(kMagic.begin(), kMagic.end(), header.magic);
  header.label = label;
  header.size = payload.size();
  header.stored_size = stored.size();
  ByteWriter writer;
  serialize(writer, header);
  header.checksum = checksum_of(writer.bytes, stored);
  writer.bytes.clear();
  writer.bytes.reserve(kHeaderSize + stored.size());
  serialize(writer, header);
  writer.bytes += stored;
  return std::move(writer.bytes);
}

Label verify(std::string_view bytes) {
  return check(bytes).label;
}

Content unpack(std::string_view bytes) {
  const Header header = check(bytes);
  const std::string_view stored = bytes.substr(kHeaderSize);
  if (header.size / kMaxCompressionRatio > stored.size() ||
      ZSTD_getFrameContentSize(stored.data(), stored.size()) != header.size)
    throw std::runtime_error("the size of its content is wrong");
  Content content{header.label, std::string(header.size, '\0')};
  const std::size_t size =
      ZSTD_decompress(content.payload.data(), content.payload.size(), stored.data(), stored.size());
  if (ZSTD_isError(size)) throw std::runtime_error(fmt::format("Zstandard: {}", ZSTD_getErrorName(size)));
  if (size != header.size) throw std::runtime_error("the size of its content is wrong");
  return content;
}

}  // namespace weft::cache
