// What every use of libav shares: ownership, checked return codes, its log.
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

/// Closes the file too, without looking at errors: close_output() does that where they matter.
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

/// Sends libav's log, and that of x264, to a short memory of warnings and errors instead of standard error, and empties
/// that memory. The log belongs to the process, and so does the memory. Safe from any thread.
void collect_log();

/// Throws Error(output_failed): "file: cannot <step>: <reason>", followed by libav's latest warnings.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view step, std::string_view reason);

/// Returns `code` if it is no error, else fails with av_strerror's words.
int check(int code, const std::filesystem::path& file, std::string_view step);

/// Returns `pointer` if it is not null, else fails for want of memory.
template <class Pointer>
Pointer check_allocated(Pointer pointer, const std::filesystem::path& file) {
  if (!pointer) fail(file, "start libav", "out of memory");
  return pointer;
}

}  // namespace weft::video
