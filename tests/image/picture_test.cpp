// PNG and JPEG files as pictures with alpha.
#include "film/image/picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace weft::image {
namespace {

std::string png_bytes(int width, int height, std::uint32_t format, const std::vector<std::uint8_t>& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  EXPECT_TRUE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr)) << image.message;
  bytes.resize(size);
  return bytes;
}

/// A JPEG with a dark left half and a bright right half, in the full range of values.
std::string jpeg_bytes(int width, int height, AVPixelFormat format) {
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_MJPEG);
  AVCodecContext* context = avcodec_alloc_context3(codec);
  context->width = width;
  context->height = height;
  context->pix_fmt = format;
  context->time_base = {1, 25};
  context->color_range = AVCOL_RANGE_JPEG;
  context->flags |= AV_CODEC_FLAG_QSCALE;
  context->global_quality = FF_QP2LAMBDA;
  EXPECT_GE(avcodec_open2(context, codec, nullptr), 0);
  AVFrame* frame = av_frame_alloc();
  frame->width = width;
  frame->height = height;
  frame->format = format;
  frame->quality = FF_QP2LAMBDA;
  EXPECT_GE(av_frame_get_buffer(frame, 0), 0);
  const int chroma_height = format == AV_PIX_FMT_YUVJ420P ? height / 2 : height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) frame->data[0][y * frame->linesize[0] + x] = x < width / 2 ? 0 : 255;
  for (const int plane : {1, 2})
    std::memset(frame->data[plane], 128, static_cast<std::size_t>(frame->linesize[plane]) * chroma_height);
  AVPacket* packet = av_packet_alloc();
  EXPECT_GE(avcodec_send_frame(context, frame), 0);
  EXPECT_GE(avcodec_receive_packet(context, packet), 0);
  std::string bytes(reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size));
  av_packet_free(&packet);
  av_frame_free(&frame);
  avcodec_free_context(&context);
  return bytes;
}

std::string complaint(const std::string& bytes) {
  try {
    decode_picture(bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(PictureFile, PngKeepsEveryByteOfColorAndAlpha) {
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 255, 40, 50, 60, 0, 7, 8, 9, 128, 255, 0, 255, 1};
  const Picture picture = decode_picture(png_bytes(2, 2, PNG_FORMAT_RGBA, pixels));
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 2);
  EXPECT_EQ(picture.rgba, pixels);
}

TEST(PictureFile, GrayPngIsOpaque) {
  const Picture picture = decode_picture(png_bytes(2, 1, PNG_FORMAT_GRAY, {10, 200}));
  EXPECT_EQ(picture.rgba, (std::vector<std::uint8_t>{10, 10, 10, 255, 200, 200, 200, 255}));
}

// Many programs write files that do not state their gamma, so the test removes the chunk gAMA.
TEST(PictureFile, PngOfSixteenBitsHasTheColorsOfOneOfEight) {
  std::string bytes = png_bytes(2, 1, PNG_FORMAT_LINEAR_Y, {0x80, 0x80, 0x20, 0x20});
  constexpr std::size_t kLength = 4, kChunk = 16;  // [bytes]: the length before the name, and the whole chunk
  bytes.erase(bytes.find("gAMA") - kLength, kChunk);
  const std::vector<std::uint8_t> expected{0x80, 0x80, 0x80, 255, 0x20, 0x20, 0x20, 255};
  EXPECT_EQ(decode_picture(bytes).rgba, expected);
}

TEST(PictureFile, TgaKeepsColorsAndAlphaAndItsFirstRowIsTheLowestUnlessItSaysSo) {
  // 24-bit pixels are blue, green, red; the 32-bit picture has alpha, starts at the top and is run-length encoded.
  const std::string plain = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 24, 0, 30, 20, 10, 60, 50, 40};
  EXPECT_EQ(decode_picture(plain).rgba, (std::vector<std::uint8_t>{40, 50, 60, 255, 10, 20, 30, 255}));
  const std::string runs = {0,  0,  10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28, static_cast<char>(0x81),
                            30, 20, 10, 5};
  EXPECT_EQ(decode_picture(runs).rgba, (std::vector<std::uint8_t>{10, 20, 30, 5, 10, 20, 30, 5}));
  EXPECT_NE(complaint(plain.substr(0, 20)), "");
}

// The encoder preserves uniform halves to within two levels. Black and white are correct only if the full range is
// recognised; otherwise they become 16 and 235.
TEST(PictureFile, JpegHasTheFullRangeWhateverItsColorsAreStoredLike) {
  for (const AVPixelFormat format : {AV_PIX_FMT_YUVJ420P, AV_PIX_FMT_YUVJ444P}) {
    const Picture picture = decode_picture(jpeg_bytes(64, 32, format));
    ASSERT_EQ(picture.width, 64);
    ASSERT_EQ(picture.height, 32);
    const auto at = [&](int x, int channel) {
      return picture.rgba[4 * (16 * 64 + static_cast<std::size_t>(x)) + channel];
    };
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_LE(at(8, channel), 2);
      EXPECT_GE(at(56, channel), 253);
    }
    EXPECT_EQ(at(8, 3), 255);
  }
}

// Phones append a video to a photo. A thumbnail is a JPEG in a segment before the pixels, with an end marker.
TEST(PictureFile, JpegMayHaveOtherDataBehindItsEndButMustHaveIt) {
  const std::string jpeg = jpeg_bytes(64, 32, AV_PIX_FMT_YUVJ420P);
  EXPECT_EQ(decode_picture(jpeg + std::string(5000, 'v')).rgba, decode_picture(jpeg).rgba);
  // A segment states its length without its marker, 24 bytes.
  const std::string thumbnail = std::string("\xff\xe1\x00\x18", 4) + std::string(18, 't') + "\xff\xd8\xff\xd9";
  std::string photo = jpeg;
  photo.insert(2, thumbnail);
  EXPECT_EQ(decode_picture(photo).rgba, decode_picture(jpeg).rgba);
  EXPECT_EQ(complaint(photo.substr(0, photo.size() / 2)), "the file ends too early");
}

TEST(PictureFile, WhatIsBrokenOrSomethingElseIsRefusedWithTheReason) {
  const std::string png = png_bytes(20, 20, PNG_FORMAT_RGBA, std::vector<std::uint8_t>(1600, 77));
  const std::string jpeg = jpeg_bytes(64, 32, AV_PIX_FMT_YUVJ420P);
  EXPECT_EQ(complaint(""), "the file is empty");
  EXPECT_EQ(complaint("GIF89a..."), "it begins like no picture");
  EXPECT_NE(complaint(png.substr(0, png.size() / 2)), "");
  EXPECT_NE(complaint(png.substr(0, 12)), "");
  EXPECT_EQ(complaint(jpeg.substr(0, jpeg.size() / 2)), "the file ends too early");
  std::string wide = png;
  wide[16] = 0x7f;  // the first byte of the width; the checksum is now wrong
  EXPECT_NE(complaint(wide), "");
}

}  // namespace
}  // namespace weft::image
