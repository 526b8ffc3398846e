#include "film/image/png.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>

#include <cstdint>
#include <string>

#include "support/test_folder.hpp"

namespace weft::image {
namespace {

using support::expect_error;
using support::read_bytes;
using support::write_bytes;

using PngTest = support::TestFolder;

// A picture in which neighbouring pixels differ, so that the test detects swapped rows, columns or channels.
Image patterned(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* p = image.pixel(x, y);
      p[0] = static_cast<std::uint8_t>(7 * x + 3 * y);
      p[1] = static_cast<std::uint8_t>(200 - 5 * x + 11 * y);
      p[2] = static_cast<std::uint8_t>(x * y + 1);
    }
  }
  return image;
}

// Writes pixels in another layout of libpng, with its simplified API.
void write_other_layout(const std::filesystem::path& file, int width, int height, std::uint32_t format,
                        const void* pixels) {
  png_image other{};
  other.version = PNG_IMAGE_VERSION;
  other.width = static_cast<png_uint_32>(width);
  other.height = static_cast<png_uint_32>(height);
  other.format = format;
  ASSERT_TRUE(png_image_write_to_file(&other, file.c_str(), 0, pixels, 0, nullptr)) << other.message;
}

TEST_F(PngTest, RoundTripKeepsEveryByte) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {97, 61}}) {
    const Image image = patterned(width, height);
    write_png(folder_ / "a.png", image);
    const Image back = read_png(folder_ / "a.png");
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.rgb, image.rgb);
  }
}

TEST_F(PngTest, SixteenBitsAreKeptHighByteFirst) {
  Image16 image{3, 2, {}};
  for (int k = 0; k < 18; ++k) image.rgb.push_back(static_cast<std::uint16_t>(257 * 13 * k + 5));
  write_png((folder_ / "deep.png"), image);
  const std::string bytes = read_bytes((folder_ / "deep.png"));
  EXPECT_EQ(bytes[24], 16) << "bit depth in the header";
  const Image read = read_png((folder_ / "deep.png"));
  for (int k = 0; k < 18; ++k) EXPECT_EQ(read.rgb[k], 13 * k) << "rounded to bytes";
}

TEST_F(PngTest, MetadataComesBackInAnyLanguage) {
  const Metadata metadata = {{"Weft scene hash", "8f31"}, {"GL", "Mesa 22.3.6"}, {"Scene", "scenes/Tücher 布.toml"}};
  write_png(folder_ / "a.png", patterned(4, 4), metadata);
  Metadata back;
  read_png(folder_ / "a.png", &back);
  EXPECT_EQ(back, metadata);
}

TEST_F(PngTest, PlainTextIsATextChunkAndTheColourSpaceIsNamed) {
  write_png(folder_ / "a.png", patterned(4, 4), {{"Frame", "12"}});
  const std::string bytes = read_bytes(folder_ / "a.png");
  EXPECT_NE(bytes.find(std::string("tEXtFrame\0"
                                   "12",
                                   12)),
            std::string::npos);
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
}

TEST_F(PngTest, SameImageSameBytes) {
  write_png(folder_ / "a.png", patterned(50, 40), {{"Frame", "1"}});
  write_png(folder_ / "b.png", patterned(50, 40), {{"Frame", "1"}});
  EXPECT_EQ(read_bytes(folder_ / "a.png"), read_bytes(folder_ / "b.png"));
}

TEST_F(PngTest, GrayIsReadAsThreeEqualChannels) {
  const std::uint8_t gray[] = {0, 90, 255};
  write_other_layout(folder_ / "gray.png", 3, 1, PNG_FORMAT_GRAY, gray);
  const std::vector<std::uint8_t> expected = {0, 0, 0, 90, 90, 90, 255, 255, 255};
  EXPECT_EQ(read_png(folder_ / "gray.png").rgb, expected);
}

TEST_F(PngTest, AlphaIsLaidOverWhite) {
  // Three pixels: opaque; transparent; (200, 100, 0) with alpha 102/255 = 0.4, which gives 0.4 * 200 + 0.6 * 255 = 233,
  // 0.4 * 100 + 153 = 193, and 153.
  const std::uint8_t rgba[] = {10, 20, 30, 255, 10, 20, 30, 0, 200, 100, 0, 102};
  write_other_layout(folder_ / "alpha.png", 3, 1, PNG_FORMAT_RGBA, rgba);
  const std::vector<std::uint8_t> expected = {10, 20, 30, 255, 255, 255, 233, 193, 153};
  EXPECT_EQ(read_png(folder_ / "alpha.png").rgb, expected);
}

TEST_F(PngTest, PaletteIsReadAsColours) {
  const std::uint8_t map[] = {255, 0, 0, 0, 128, 255};
  const std::uint8_t indices[] = {1, 0, 1, 1};
  png_image other{};
  other.version = PNG_IMAGE_VERSION;
  other.width = other.height = 2;
  other.format = PNG_FORMAT_RGB_COLORMAP;
  other.colormap_entries = 2;
  ASSERT_TRUE(png_image_write_to_file(&other, (folder_ / "p.png").c_str(), 0, indices, 0, map)) << other.message;
  const std::vector<std::uint8_t> expected = {0, 128, 255, 255, 0, 0, 0, 128, 255, 0, 128, 255};
  EXPECT_EQ(read_png(folder_ / "p.png").rgb, expected);
}

TEST_F(PngTest, EveryTruncationIsAnError) {
  write_png(folder_ / "a.png", patterned(9, 7), {{"Frame", "12"}});
  const std::string bytes = read_bytes(folder_ / "a.png");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write_bytes(folder_ / "cut.png", bytes.substr(0, size));
    expect_error(ExitCode::asset_unreadable,
                 "cut.png: cannot be read as PNG: ", [&] { read_png(folder_ / "cut.png"); });
  }
}

TEST_F(PngTest, EveryChangedByteIsAnError) {
  write_png(folder_ / "a.png", patterned(9, 7), {{"Frame", "12"}});
  const std::string bytes = read_bytes(folder_ / "a.png");
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int flip : {0x01, 0x20, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      write_bytes(folder_ / "flip.png", damaged);
      SCOPED_TRACE(fmt::format("byte {} of {}, flip {:#x}", at, bytes.size(), flip));
      expect_error(ExitCode::asset_unreadable, "flip.png", [&] { read_png(folder_ / "flip.png"); });
    }
  }
}

TEST_F(PngTest, HugeSizesInTheHeaderAreRefusedBeforeMemoryIsTaken) {
  // The header has a valid checksum, and claims 16000x16000 pixels in a file of a few bytes.
  png_byte header[] = {'I', 'H', 'D', 'R', 0, 0, 0x3e, 0x80, 0, 0, 0x3e, 0x80, 8, 2, 0, 0, 0};
  std::uint32_t crc = 0xffffffffu;
  for (const png_byte byte : header) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) ? 0xedb88320u : 0u);
  }
  crc = ~crc;
  std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\x0d", 12);
  bytes.append(reinterpret_cast<const char*>(header), sizeof header);
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(crc >> shift);
  bytes.append("\0\0\0\x01IDAT", 8);
  write_bytes(folder_ / "huge.png", bytes);
  expect_error(ExitCode::asset_unreadable, "41 bytes cannot hold 16000x16000 pixels",
               [&] { read_png(folder_ / "huge.png"); });
}

// A text chunk claims 2 GB, the largest length that PNG allows, in a file of a hundred bytes.
TEST_F(PngTest, PromisedLengthOfAChunkIsRefusedBeforeMemoryIsTaken) {
  write_png(folder_ / "a.png", Image(2, 2), {{"key", "text"}});
  std::string bytes = read_bytes(folder_ / "a.png");
  const std::size_t length = bytes.find("tEXt") - 4;
  bytes.replace(length, 4, "\x7F\xFF\xFF\xFF");
  write_bytes(folder_ / "b.png", bytes);
  rusage before{}, after{};
  ::getrusage(RUSAGE_SELF, &before);
  expect_error(ExitCode::asset_unreadable, "the file ends too early", [&] { read_png(folder_ / "b.png"); });
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 10'000) << "KB taken";
}

TEST_F(PngTest, ReadingSaysWhatTheSystemSaid) {
  expect_error(ExitCode::asset_unreadable, "none.png: cannot be read as PNG: No such file",
               [&] { read_png(folder_ / "none.png"); });
  expect_error(ExitCode::asset_unreadable, "expected a file, got a folder", [&] { read_png(folder_); });
  write_bytes(folder_ / "text.png", "This is not a picture at all.");
  expect_error(ExitCode::asset_unreadable, "Not a PNG file", [&] { read_png(folder_ / "text.png"); });
}

TEST_F(PngTest, WritingRefusesImagesThatAreNone) {
  const auto write = [&](const Image& image) { return [&] { write_png(folder_ / "a.png", image); }; };
  expect_error(ExitCode::output_failed, "expected an image of 1 to 16384 pixels a side, got 0x0", write(Image()));
  expect_error(ExitCode::output_failed, "got 20000x1", write(Image(20000, 1)));
  Image short_image(4, 4);
  short_image.rgb.pop_back();
  expect_error(ExitCode::output_failed, "got 4x4 with 47 bytes", write(short_image));
  EXPECT_TRUE(files().empty());
}

TEST_F(PngTest, WritingRefusesMetadataThatPngCannotHold) {
  for (const std::string& key : {std::string(), std::string(80, 'k'), std::string(" k"), std::string("Größe")}) {
    expect_error(ExitCode::output_failed, "expected a key of 1 to 79 ASCII characters", [&] {
      write_png(folder_ / "a.png", patterned(2, 2), {{key, "v"}});
    });
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(PngTest, FailedWritingLeavesNothingBehind) {
  write_bytes(folder_ / "file", "");
  expect_error(ExitCode::output_failed, "Not a directory",
               [&] { write_png(folder_ / "file" / "a.png", patterned(2, 2)); });
  EXPECT_EQ(files(), std::vector<std::string>{"file"});
}

}  // namespace
}  // namespace weft::image
