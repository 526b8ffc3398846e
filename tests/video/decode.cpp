#include "decode.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/test_folder.hpp"

namespace weft::video {
namespace {

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

// ITU-R BT.709-6: Y' = 0.2126 R' + 0.7152 G' + 0.0722 B', Y' in 16..235 and the colour differences in 16..240.
image::Image to_rgb(const AVFrame& frame) {
  image::Image image(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const double luma = (frame.data[0][y * frame.linesize[0] + x] - 16) / 219.0;
      const double blue = luma + 1.8556 * (frame.data[1][y / 2 * frame.linesize[1] + x / 2] - 128) / 224.0;
      const double red = luma + 1.5748 * (frame.data[2][y / 2 * frame.linesize[2] + x / 2] - 128) / 224.0;
      const double green = (luma - 0.2126 * red - 0.0722 * blue) / 0.7152;
      std::uint8_t* p = image.pixel(x, y);
      p[0] = to_byte(red);
      p[1] = to_byte(green);
      p[2] = to_byte(blue);
    }
  }
  return image;
}

// Receives the frames that the decoder has ready.
void receive(AVCodecContext& codec, AVFrame& frame, AVRational unit, DecodedVideo& video) {
  while (avcodec_receive_frame(&codec, &frame) == 0) {
    const AVRational time = av_mul_q({static_cast<int>(frame.best_effort_timestamp), 1}, unit);
    video.frames.push_back(
        {time, frame.color_range, frame.colorspace, frame.color_primaries, frame.color_trc, to_rgb(frame)});
  }
}

}  // namespace

DecodedVideo decode(const std::filesystem::path& file) {
  DecodedVideo video;
  AVFormatContext* opened = nullptr;
  const int open_code = avformat_open_input(&opened, std::filesystem::absolute(file).c_str(), nullptr, nullptr);
  const InputPtr input(opened);
  if (open_code < 0 || input->nb_streams != 1) {
    ADD_FAILURE() << file << " does not open as a video of one stream";
    return video;
  }
  for (const AVDictionaryEntry* e = nullptr; (e = av_dict_get(input->metadata, "", e, AV_DICT_IGNORE_SUFFIX));) {
    video.metadata[e->key] = e->value;
  }
  const AVStream& stream = *input->streams[0];
  const CodecPtr codec(avcodec_alloc_context3(avcodec_find_decoder(stream.codecpar->codec_id)));
  EXPECT_GE(avcodec_parameters_to_context(codec.get(), stream.codecpar), 0);
  EXPECT_EQ(avcodec_open2(codec.get(), nullptr, nullptr), 0);

  const PacketPtr packet(av_packet_alloc());
  const FramePtr frame(av_frame_alloc());
  while (av_read_frame(input.get(), packet.get()) == 0) {
    EXPECT_EQ(avcodec_send_packet(codec.get(), packet.get()), 0);
    av_packet_unref(packet.get());
    receive(*codec, *frame, stream.time_base, video);
  }
  EXPECT_EQ(avcodec_send_packet(codec.get(), nullptr), 0);
  receive(*codec, *frame, stream.time_base, video);
  video.width = codec->width;
  video.height = codec->height;
  video.pixel_format = codec->pix_fmt;
  return video;
}

std::vector<std::string> mp4_boxes(const std::filesystem::path& file) {
  const std::string bytes = support::read_bytes(file);
  std::vector<std::string> names;
  for (std::size_t at = 0; at + 8 <= bytes.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(bytes[at + i]);
    names.push_back(bytes.substr(at + 4, 4));
    if (size < 8) break;
    at += size;
  }
  return names;
}

}  // namespace weft::video
