#include <fmt/format.h>
#include <png.h>

#include "film/image/picture.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/imgutils.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace weft::image {
namespace {

struct Deleter {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

[[noreturn]] void fail(const std::string& why) {
  throw std::runtime_error(why);
}

void check_size(std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1 || width > kMaxPictureSide || height > kMaxPictureSide)
    fail(fmt::format("expected 1 to {} pixels a side, got {}x{}", kMaxPictureSide, width, height));
}

Picture decode_png(std::string_view bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Picture picture;
  // If this call fails, libpng frees its own memory.
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) fail(png.message);
  try {
    check_size(png.width, png.height);
    // Refuses a damaged file that claims too many pixels before memory for them is allocated. Deflate expands a byte to
    // at most 1032 bytes, and a pixel takes at least one bit.
    if (std::uint64_t{png.width} * png.height / 8 > 1032 * bytes.size())
      fail(fmt::format("{} bytes cannot hold {}x{} pixels", bytes.size(), png.width, png.height));
    picture.width = static_cast<int>(png.width);
    picture.height = static_cast<int>(png.height);
    png.format = PNG_FORMAT_RGBA;
    // Without this flag, libpng takes 16-bit values for linear light if the file does not name its gamma.
    png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    picture.rgba.resize(PNG_IMAGE_SIZE(png));
  } catch (...) {
    png_image_free(&png);
    throw;
  }
  if (png_image_finish_read(&png, nullptr, picture.rgba.data(), 0, nullptr) == 0) fail(png.message);
  return picture;
}

/// The pixel format to pass to swscale. libav gives JPEG files, which use the full range of values, separate formats
/// (YUVJ…). swscale takes the same formats without J, and the range as a parameter.
AVPixelFormat plain_format(int format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      return AV_PIX_FMT_YUV440P;
    default:
      return static_cast<AVPixelFormat>(format);
  }
}

/// Decodes the only picture of a file through libav.
Owned<AVFrame> decode_frame(std::string_view bytes, AVCodecID kind) {
  const AVCodec* codec = avcodec_find_decoder(kind);
  const Owned<AVCodecContext> context(codec ? avcodec_alloc_context3(codec) : nullptr);
  Owned<AVFrame> frame(av_frame_alloc());
  const Owned<AVPacket> packet(av_packet_alloc());
  if (!context || !frame || !packet) fail(fmt::format("libavcodec has no decoder of {}", avcodec_get_name(kind)));
  context->log_level_offset = AV_LOG_TRACE;  // libav prints nothing; the exception has its message
  context->err_recognition = AV_EF_EXPLODE | AV_EF_CRCCHECK | AV_EF_BITSTREAM;
  context->thread_count = 1;
  if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) fail("there is no memory for it");
  std::memcpy(packet->data, bytes.data(), bytes.size());
  int code = avcodec_open2(context.get(), codec, nullptr);
  if (code >= 0) code = avcodec_send_packet(context.get(), packet.get());
  if (code >= 0) code = avcodec_receive_frame(context.get(), frame.get());
  if (code < 0) {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
    av_strerror(code, reason.data(), reason.size());
    fail(reason.data());
  }
  if ((frame->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame->decode_error_flags != 0) fail("the file is damaged");
  return frame;
}

Picture to_picture(const AVFrame& frame) {
  check_size(frame.width, frame.height);
  const Owned<SwsContext> scaler(
      sws_getContext(frame.width, frame.height, plain_format(frame.format), frame.width, frame.height, AV_PIX_FMT_RGBA,
                     SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, nullptr, nullptr, nullptr));
  if (!scaler) fail("its way of storing colors is not known");
  constexpr int kFullRange = 1, kUnchanged = 1 << 16;
  const int* coefficients = sws_getCoefficients(SWS_CS_ITU601);
  sws_setColorspaceDetails(scaler.get(), coefficients, kFullRange, coefficients, kFullRange, 0, kUnchanged, kUnchanged);
  Picture picture{frame.width, frame.height, {}};
  picture.rgba.resize(4 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  std::uint8_t* const planes[4] = {picture.rgba.data()};  // swscale reads four pointers
  const int strides[4] = {4 * picture.width};
  if (sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, planes, strides) != frame.height)
    fail("its colors could not be converted");
  return picture;
}

/// Whether a JPEG file has an end marker after its pixels. Skips the segments before the pixels, because a thumbnail in
/// them has an end marker, too. After the marker, the file may have other data, such as the video that phones append.
bool has_end_of_jpeg(std::string_view bytes) {
  const auto at = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U; };
  constexpr unsigned kMarker = 0xff, kPixels = 0xda;
  std::size_t segment = 2;  // after the start marker
  while (at(segment) == kMarker && at(segment + 1) != kPixels)
    segment += at(segment + 1) == kMarker ? 1U : 2U + 256U * at(segment + 2) + at(segment + 3);
  return bytes.find("\xff\xd9", segment) != std::string_view::npos;
}

Picture decode_jpeg(std::string_view bytes) {
  // libav fills the missing part of a truncated file with grey.
  if (!has_end_of_jpeg(bytes)) fail("the file ends too early");
  return to_picture(*decode_frame(bytes, AV_CODEC_ID_MJPEG));
}

}  // namespace

Picture decode_picture(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return decode_png(bytes);
  if (bytes.starts_with("\xff\xd8\xff")) return decode_jpeg(bytes);
  if (is_targa(bytes)) return to_picture(*decode_frame(bytes, AV_CODEC_ID_TARGA));
  fail(bytes.empty() ? "the file is empty" : "it begins like no picture");
}

}  // namespace weft::image
