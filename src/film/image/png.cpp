#include "film/image/png.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/temporary_file.hpp"

// libpng reports errors by longjmp, which skips destructors. Each function below that calls setjmp therefore holds only
// plain data and returns false on an error; its caller owns all resources and throws.

namespace weft::image {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// zlib level and row filter. Measured on rendered frames of 1280×720 pixels: with these values, 19 ms of CPU time and
// 62 KB per frame; with libpng's default filters, 27 ms and 65 KB; with level 3, 8 ms and 90 KB.
constexpr int kLevel = 6;
constexpr int kFilter = PNG_FILTER_SUB;

// Deflate expands a byte to at most 1032 bytes (RFC 1951: 258 bytes from two bits). read_png() refuses a damaged file
// that claims more pixels before it allocates memory for them.
constexpr std::uintmax_t kMaxDeflateRatio = 1032;

// An error message of libpng or the system, stored outside the stack frames that a longjmp skips.
struct ErrorText {
  std::array<char, 256> text{};
  void set(const char* words) { std::snprintf(text.data(), text.size(), "%s", words); }
};

void on_error(png_structp png, png_const_charp words) {
  auto* error_text = static_cast<ErrorText*>(png_get_error_ptr(png));
  if (error_text->text[0] == '\0') error_text->set(words);
  png_longjmp(png, 1);
}

// Ignores warnings: they concern private chunks and colour profiles, which this reader does not use.
void on_warning(png_structp, png_const_charp) {}

// Stores the system's error message, because libpng passes only its own text to on_error().
void write_bytes(png_structp png, png_bytep data, std::size_t size) {
  auto* file = static_cast<std::FILE*>(png_get_io_ptr(png));
  if (std::fwrite(data, 1, size, file) == size) return;
  static_cast<ErrorText*>(png_get_error_ptr(png))->set(std::strerror(errno));
  png_error(png, "write failed");
}

void flush_bytes(png_structp) {}

void read_bytes(png_structp png, png_bytep data, std::size_t size) {
  auto* file = static_cast<std::FILE*>(png_get_io_ptr(png));
  if (std::fread(data, 1, size, file) == size) return;
  auto* error_text = static_cast<ErrorText*>(png_get_error_ptr(png));
  error_text->set(std::ferror(file) ? std::strerror(errno) : "the file ends too early");
  png_error(png, "read failed");
}

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Writer(ErrorText* error_text)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, error_text, on_error, on_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {}
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
};

struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Reader(ErrorText* error_text)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, error_text, on_error, on_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {}
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

/// `width` x `height` pixels with `bits` per channel, top row first; 16-bit values have the byte order of this machine.
struct Rows {
  int width, height, bits;
  const png_byte* first;
  int channels = 3;  // 4: with alpha
  std::size_t row_bytes() const { return static_cast<std::size_t>(width) * channels * bits / 8; }
};

bool write_all(const Writer& writer, const Rows& rows, std::FILE* file, png_text* texts, int text_count) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, file, write_bytes, flush_bytes);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(rows.width), static_cast<png_uint_32>(rows.height),
               rows.bits, rows.channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (text_count > 0) png_set_text(writer.png, writer.info, texts, text_count);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, kFilter);
  png_set_compression_level(writer.png, kLevel);
  png_write_info(writer.png, writer.info);
  if (rows.bits == 16 && std::endian::native == std::endian::little) png_set_swap(writer.png);
  for (int y = 0; y < rows.height; ++y) png_write_row(writer.png, rows.first + y * rows.row_bytes());
  png_write_end(writer.png, nullptr);
  return true;
}

// Reads the file up to its pixels.
bool read_header(const Reader& reader, std::FILE* file) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, file, read_bytes);
  png_set_user_limits(reader.png, kMaxPngSide, kMaxPngSide);
  // A damaged chunk is an error even if it contains only metadata, because reference images must be intact.
  png_set_crc_action(reader.png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_read_info(reader.png, reader.info);
  return true;
}

bool ask_for_rgb(const Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);
  png_set_scale_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  // Blends over white in sRGB values, as browsers do. Equal gammas prevent libpng from blending in linear light if the
  // file states its gamma.
  png_set_gamma(reader.png, 1.0, 1.0);
  png_color_16 white{};
  white.red = white.green = white.blue = white.gray = 255;
  png_set_background(reader.png, &white, PNG_BACKGROUND_GAMMA_SCREEN, 0, 1.0);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool read_rows(const Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, reader.info);
  return true;
}

bool is_ascii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x80; });
}

// Whether a key has 1 to 79 printable ASCII characters without spaces at the ends, as PNG requires.
// libpng would silently change other keys.
bool is_key(std::string_view key) {
  const bool printable = std::all_of(key.begin(), key.end(), [](unsigned char c) { return c >= 32 && c < 127; });
  return printable && !key.empty() && key.size() < 80 && key.front() != ' ' && key.back() != ' ';
}

// Text chunks that point into `metadata`. tEXt is Latin-1, so text other than ASCII goes into an iTXt chunk as UTF-8.
std::vector<png_text> text_chunks(const std::filesystem::path& file, const Metadata& metadata) {
  std::vector<png_text> texts;
  for (const auto& [key, value] : metadata) {
    if (!is_key(key) || value.find('\0') != std::string::npos) {
      throw Error(ExitCode::output_failed,
                  "{}: metadata \"{}\": expected a key of 1 to 79 ASCII characters and a text without zero bytes",
                  file.string(), key);
    }
    png_text text{};
    text.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(key.c_str());
    text.text = const_cast<char*>(value.c_str());
    texts.push_back(text);
  }
  return texts;
}

Metadata metadata_of(const Reader& reader) {
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &texts, &count);
  Metadata metadata;
  for (int i = 0; i < count; ++i) metadata[texts[i].key] = texts[i].text;
  return metadata;
}

[[noreturn]] void fail_to_read(const std::filesystem::path& file, std::string_view words) {
  throw Error(ExitCode::asset_unreadable, "{}: cannot be read as PNG: {}", file.string(), words);
}

[[noreturn]] void fail_to_write(const std::filesystem::path& file, std::string_view words) {
  throw Error(ExitCode::output_failed, "{}: cannot be written: {}", file.string(), words);
}

// Checks that no chunk is longer than the rest of the file, because libpng allocates the length that the chunk claims,
// up to 2 GB, before it reads. Does nothing for files that are not PNG: libpng reports them.
void check_chunks(const std::filesystem::path& file, std::FILE* in, std::uintmax_t file_size) {
  // Size of the signature, and total size of the length, name and checksum of a chunk [bytes].
  constexpr std::uintmax_t kSignature = 8, kAround = 12;
  std::array<png_byte, kSignature> signature{};
  const bool is_png = std::fread(signature.data(), 1, kSignature, in) == kSignature &&
                      png_sig_cmp(signature.data(), 0, kSignature) == 0;
  std::array<png_byte, 4> length{};
  for (std::uintmax_t chunk = kSignature; is_png && chunk + kAround <= file_size;
       chunk += kAround + png_get_uint_32(length.data())) {
    const bool read = std::fseek(in, static_cast<long>(chunk), SEEK_SET) == 0 &&
                      std::fread(length.data(), 1, length.size(), in) == length.size();
    if (!read) fail_to_read(file, std::strerror(errno));
    if (png_get_uint_32(length.data()) > file_size - chunk - kAround) fail_to_read(file, "the file ends too early");
  }
  std::rewind(in);
}

// Throws if a side is out of range, or if `bytes`, the size of the data, does not fit `rows`.
void check_size(const std::filesystem::path& file, const Rows& rows, std::size_t bytes) {
  const bool in_range = rows.width >= 1 && rows.height >= 1 && rows.width <= kMaxPngSide && rows.height <= kMaxPngSide;
  if (!in_range || bytes != rows.row_bytes() * static_cast<std::size_t>(rows.height)) {
    throw Error(ExitCode::output_failed, "{}: expected an image of 1 to {} pixels a side, got {}x{} with {} bytes",
                file.string(), kMaxPngSide, rows.width, rows.height, bytes);
  }
}

// Writes a PNG to `out`, and closes it.
void encode(const std::filesystem::path& file, const Rows& rows, std::vector<png_text> texts, File out) {
  if (!out) fail_to_write(file, std::strerror(errno));
  ErrorText error_text;
  const Writer writer(&error_text);
  if (!writer.info) fail_to_write(file, "libpng could not start");
  if (!write_all(writer, rows, out.get(), texts.data(), static_cast<int>(texts.size()))) {
    fail_to_write(file, error_text.text.data());
  }
  // If the disk is full, fclose() may be the first call to fail, because it writes the last bytes.
  if (std::fclose(out.release()) != 0) fail_to_write(file, std::strerror(errno));
}

void write(const std::filesystem::path& file, const Rows& rows, std::size_t bytes, const Metadata& metadata) {
  check_size(file, rows, bytes);
  std::vector<png_text> texts = text_chunks(file, metadata);

  TemporaryFile temporary(file);
  encode(file, rows, std::move(texts), File(std::fopen(temporary.path().c_str(), "wbe"), std::fclose));
  temporary.commit();
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image, const Metadata& metadata) {
  write(file, {image.width, image.height, 8, image.rgb.data()}, image.rgb.size(), metadata);
}

void write_png(const std::filesystem::path& file, const Image16& image, const Metadata& metadata) {
  write(file, {image.width, image.height, 16, reinterpret_cast<const png_byte*>(image.rgb.data())},
        2 * image.rgb.size(), metadata);
}

namespace {

// Encodes a picture in memory. `bytes`: size of the data in `rows`.
std::string bytes_of(const Rows& rows, std::size_t bytes) {
  const std::filesystem::path name = "a picture in memory";
  check_size(name, rows, bytes);
  char* buffer = nullptr;
  std::size_t size = 0;
  const auto free_buffer = [](char** text) { std::free(*text); };  // NOLINT: memory of open_memstream()
  const std::unique_ptr<char*, decltype(free_buffer)> owner(&buffer, free_buffer);  // must outlive the stream
  encode(name, rows, {}, File(::open_memstream(&buffer, &size), std::fclose));
  return {buffer, size};
}

}  // namespace

std::string png_bytes(const Image& image) {
  return bytes_of({image.width, image.height, 8, image.rgb.data()}, image.rgb.size());
}

std::string png_bytes(const Picture& picture) {
  return bytes_of({picture.width, picture.height, 8, picture.rgba.data(), 4}, picture.rgba.size());
}

namespace {

/// An open PNG file, which is read up to its pixels.
struct Opened {
  File in{nullptr, std::fclose};
  std::uintmax_t size = 0;  // [bytes]
  ErrorText error_text;
  Reader reader{&error_text};

  explicit Opened(const std::filesystem::path& file) {
    try {
      check_is_file(file);
    } catch (const std::runtime_error& error) {
      fail_to_read(file, error.what());
    }
    in.reset(std::fopen(file.c_str(), "rbe"));
    if (!in) fail_to_read(file, std::strerror(errno));
    std::error_code error;
    size = std::filesystem::file_size(file, error);
    if (error) fail_to_read(file, error.message());
    check_chunks(file, in.get(), size);
    if (!reader.info) fail_to_read(file, "libpng could not start");
    if (!read_header(reader, in.get())) fail_to_read(file, error_text.text.data());
  }
};

}  // namespace

Metadata read_png_metadata(const std::filesystem::path& file) {
  return metadata_of(Opened(file).reader);
}

Image read_png(const std::filesystem::path& file, Metadata* metadata) {
  const Opened opened(file);
  const Reader& reader = opened.reader;
  const ErrorText& error_text = opened.error_text;

  // Checks the size that the header claims before memory for the pixels is allocated.
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  const std::uintmax_t packed_size = std::uintmax_t{height} * png_get_rowbytes(reader.png, reader.info);
  if (packed_size > kMaxDeflateRatio * opened.size) {
    fail_to_read(file, fmt::format("{} bytes cannot hold {}x{} pixels", opened.size, width, height));
  }

  if (!ask_for_rgb(reader)) fail_to_read(file, error_text.text.data());
  Image image(static_cast<int>(width), static_cast<int>(height));
  if (png_get_rowbytes(reader.png, reader.info) != 3 * std::size_t{width}) {
    fail_to_read(file, "libpng did not convert it to 8-bit RGB");
  }
  std::vector<png_bytep> rows(height);
  for (png_uint_32 y = 0; y < height; ++y) rows[y] = image.pixel(0, static_cast<int>(y));
  if (!read_rows(reader, rows.data())) fail_to_read(file, error_text.text.data());
  if (metadata) *metadata = metadata_of(reader);
  return image;
}

}  // namespace weft::image
