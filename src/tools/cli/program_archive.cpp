#include "tools/cli/program_archive.hpp"

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/temporary_file.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(ExitCode::asset_unreadable, "{}: expected weft-x86_64.tar.zst as ninja bundle makes it, got {}",
              file.string(), reason);
}

/// Checks the headers of a POSIX ustar archive that it receives as consecutive parts.
class TarHeaders {
 public:
  /// Adds the next part of the archive. Throws std::runtime_error with the defect.
  void add(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t count = std::min(bytes.size(), skip_ > 0 ? skip_ : kBlock - header_.size());
      if (skip_ > 0)
        skip_ -= count;
      else
        header_.append(bytes.substr(0, count));
      bytes.remove_prefix(count);
      if (header_.size() == kBlock) read_header();
    }
  }

  void finish() const {
    if (!ended_) throw std::runtime_error("a tar archive that is cut off");
    for (const char* name : {"weft/bin/weft", "weft/bin/weft-tools", "weft/libexec/weft", "weft/libexec/weft-tools"})
      if (!names_.contains(name)) throw std::runtime_error(fmt::format("a tar archive without {}", name));
  }

 private:
  static constexpr std::size_t kBlock = 512;  // [bytes]

  std::string field(std::size_t begin, std::size_t length) const {
    const std::string text = header_.substr(begin, length);
    return text.substr(0, text.find('\0'));
  }

  // Reads a complete header. Offsets and lengths of its fields: POSIX.1-2017, pax, "ustar Interchange Format".
  void read_header() {
    if (header_.find_first_not_of('\0') == std::string::npos) {
      ended_ = true;
      header_.clear();
      return;
    }
    if (field(257, 5) != "ustar") throw std::runtime_error("no tar archive");
    const std::string prefix = field(345, 155), name = (prefix.empty() ? "" : prefix + "/") + field(0, 100);
    const char type = header_[156];
    const fs::path path(name);
    if (path.begin() == path.end() || *path.begin() != "weft" || std::ranges::find(path, "..") != path.end())
      throw std::runtime_error(fmt::format("a tar archive with {}, which is outside of the folder weft", name));
    if (type != '0' && type != '5')
      throw std::runtime_error(fmt::format("a tar archive in which {} is neither a file nor a folder", name));
    const std::string digits = field(124, 12);
    std::size_t size = 0;
    const char* end = digits.data() + digits.size();
    if (std::from_chars(digits.data(), end, size, 8).ec != std::errc{} || size > kLargestFile)
      throw std::runtime_error(fmt::format("a tar archive in which the size of {} makes no sense", name));
    names_.insert(name);
    skip_ = (size + kBlock - 1) / kBlock * kBlock;
    header_.clear();
  }

  static constexpr std::size_t kLargestFile = std::size_t{1} << 33;  // [bytes]; limit of 11 octal digits

  std::string header_;    // bytes of the current header that have arrived
  std::size_t skip_ = 0;  // remaining bytes of the current file, before the next header
  bool ended_ = false;    // whether a block of zeros has arrived, which ends the archive
  std::set<std::string> names_;
};

/// Calls `take` with consecutive parts of the decompressed bytes. Throws std::runtime_error with the defect.
void decompress(const std::string& compressed, const std::function<void(std::string_view)>& take) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  std::vector<char> buffer(ZSTD_DStreamOutSize());
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  std::size_t left = 1;  // 0: at the end of a zstd frame
  while (in.pos < in.size || left != 0) {
    ZSTD_outBuffer out{buffer.data(), buffer.size(), 0};
    const std::size_t read = in.pos;
    left = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(left))
      throw std::runtime_error(fmt::format("a file that zstd does not decompress ({})", ZSTD_getErrorName(left)));
    if (out.pos == 0 && in.pos == read) throw std::runtime_error("a file that is cut off");
    take({buffer.data(), out.pos});
  }
}

}  // namespace

ProgramArchive::ProgramArchive(const fs::path& file)
    : compressed_(read_file(file)),
      fingerprint_(fmt::format("{:016x}", XXH3_64bits(compressed_.data(), compressed_.size()))) {
  TarHeaders headers;
  try {
    decompress(compressed_, [&](std::string_view bytes) { headers.add(bytes); });
    headers.finish();
  } catch (const std::runtime_error& error) {
    fail(file, error.what());
  }
}

void ProgramArchive::write_tar(const fs::path& tar) const {
  TemporaryFile file(tar);
  std::ofstream out(file.path(), std::ios::binary);
  decompress(compressed_,
             [&](std::string_view bytes) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
  out.close();
  if (!out) throw Error(ExitCode::output_failed, "{}: cannot be written: {}", tar.string(), std::strerror(errno));
  file.commit();
}

}  // namespace weft::cli
