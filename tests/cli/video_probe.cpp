#include "cli/video_probe.hpp"

#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace weft::cli {
namespace {

struct Input {
  AVFormatContext* format = nullptr;
  AVCodecContext* decoder = nullptr;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  ~Input() {
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&decoder);
    avformat_close_input(&format);
  }
};

// Receives all frames that the decoder has ready. Returns false after an error.
bool receive_frames(Input& input, VideoFacts& facts) {
  for (;;) {
    const int status = avcodec_receive_frame(input.decoder, input.frame);
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return true;
    if (status < 0) return false;
    ++facts.frames;
  }
}

bool decode(Input& input, const std::filesystem::path& file, VideoFacts& facts) {
  if (avformat_open_input(&input.format, file.c_str(), nullptr, nullptr) < 0) return false;
  if (avformat_find_stream_info(input.format, nullptr) < 0) return false;
  const AVCodec* codec = nullptr;
  const int stream = av_find_best_stream(input.format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
  if (stream < 0) return false;
  const AVStream* video = input.format->streams[stream];
  input.decoder = avcodec_alloc_context3(codec);
  if (avcodec_parameters_to_context(input.decoder, video->codecpar) < 0) return false;
  if (avcodec_open2(input.decoder, codec, nullptr) < 0) return false;
  facts.width = video->codecpar->width;
  facts.height = video->codecpar->height;
  facts.duration = static_cast<double>(video->duration) * av_q2d(video->time_base);
  const AVDictionaryEntry* entry = nullptr;
  while ((entry = av_dict_get(input.format->metadata, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr) {
    facts.metadata[entry->key] = entry->value;
  }
  while (av_read_frame(input.format, input.packet) >= 0) {
    const bool good = input.packet->stream_index != stream ||
                      (avcodec_send_packet(input.decoder, input.packet) >= 0 && receive_frames(input, facts));
    av_packet_unref(input.packet);
    if (!good) return false;
  }
  return avcodec_send_packet(input.decoder, nullptr) >= 0 && receive_frames(input, facts);
}

}  // namespace

VideoFacts probe_video(const std::filesystem::path& file) {
  Input input;
  VideoFacts facts;
  if (!decode(input, file, facts)) facts.frames = -1;
  return facts;
}

}  // namespace weft::cli
