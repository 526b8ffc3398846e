// Helpers for libav: owning pointers, checks of return codes, log.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace weft::video {

struct LibavDeleter {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVCodecParameters* parameters) const { avcodec_parameters_free(&parameters); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

/// Closes the file and frees the context. Ignores errors; VideoFileWriter::close() reports them.
struct OutputDeleter {
  void operator()(AVFormatContext* output) const;
};

struct InputDeleter {
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
};

using CodecPtr = std::unique_ptr<AVCodecContext, LibavDeleter>;
using ParametersPtr = std::unique_ptr<AVCodecParameters, LibavDeleter>;
using FramePtr = std::unique_ptr<AVFrame, LibavDeleter>;
using PacketPtr = std::unique_ptr<AVPacket, LibavDeleter>;
using ScalerPtr = std::unique_ptr<SwsContext, LibavDeleter>;
using OutputPtr = std::unique_ptr<AVFormatContext, OutputDeleter>;
using InputPtr = std::unique_ptr<AVFormatContext, InputDeleter>;

/// Redirects the log of libav and x264 from standard error to the log buffer, and empties this buffer. The whole
/// process has one log buffer, which holds the last four different warnings and errors. Thread-safe.
void collect_log();

/// Throws Error(output_failed): "file: cannot <step>: <reason>", followed by the content of the log buffer. Empties
/// this buffer.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view step, std::string_view reason);

/// Returns `code` if it is not an error (at least 0). Otherwise calls fail() with the text of av_strerror().
int check(int code, const std::filesystem::path& file, std::string_view step);

/// Returns `pointer` if it is not null. Otherwise calls fail() with the reason "out of memory".
template <class Pointer>
Pointer check_allocated(Pointer pointer, const std::filesystem::path& file) {
  if (!pointer) fail(file, "start libav", "out of memory");
  return pointer;
}

}  // namespace weft::video
