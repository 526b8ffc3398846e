#include "film/video/decoder.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

extern "C" {
#include <libavutil/pixdesc.h>
}

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "film/video/libav.hpp"

namespace weft::video {
namespace {

[[noreturn]] void fail_to_read(const std::filesystem::path& file, std::string_view reason) {
  throw Error(ExitCode::asset_unreadable, "{}: cannot be read as a video: {}", file.string(), reason);
}

int check_read(int code, const std::filesystem::path& file) {
  if (code >= 0) return code;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(code, reason.data(), reason.size());
  fail_to_read(file, reason.data());
}

// Makes the converter of frames to RGB. The converter uses the colour matrix that `frame` names, or BT.709 if `frame`
// names none. A wrong matrix changes colours by tens of levels (of 255).
ScalerPtr make_scaler(const AVFrame& frame, const std::filesystem::path& file) {
  ScalerPtr scaler(sws_getContext(
      frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width, frame.height, AV_PIX_FMT_RGB24,
      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, nullptr, nullptr, nullptr));
  if (!scaler) fail_to_read(file, "its colour format is not known");
  const bool named = frame.colorspace != AVCOL_SPC_UNSPECIFIED && frame.colorspace != AVCOL_SPC_RGB;
  const int* from = sws_getCoefficients(named ? static_cast<int>(frame.colorspace) : SWS_CS_ITU709);
  constexpr int kUnit = 1 << 16;  // contrast and saturation of 1 in 16.16 fixed point
  // libav ignores these settings for RGB formats.
  sws_setColorspaceDetails(scaler.get(), from, frame.color_range == AVCOL_RANGE_JPEG,
                           sws_getCoefficients(SWS_CS_ITU709), 1, 0, kUnit, kUnit);
  return scaler;
}

/// Converts a metadata key: Matroska stores keys in capitals, but Weft's keys are in lower case.
std::string lower_case(std::string key) {
  std::ranges::transform(key, key.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return key;
}

}  // namespace

struct Decoder::Impl {
  std::filesystem::path file;
  InputPtr input;
  int stream = 0;
  CodecPtr codec;
  PacketPtr packet{av_packet_alloc()};
  FramePtr frame{av_frame_alloc()};
  ScalerPtr scaler;                  // created for the first frame
  std::array<int, 3> first_shape{};  // width, height and pixel format of the first frame
  std::map<std::string, std::string> metadata;
  bool at_end = false;  // all packets of the file are read; the decoder may still hold frames

  explicit Impl(const std::filesystem::path& name) : file(name) {
    collect_log();
    AVFormatContext* opened = nullptr;
    try {
      check_is_file(file);
    } catch (const std::runtime_error& error) {
      fail_to_read(file, error.what());
    }
    // Excludes playlists: libav detects them by their content, and a playlist could make it open other files.
    AVDictionary* options = nullptr;
    av_dict_set(&options, "format_whitelist", "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi", 0);
    // The path is absolute, because in a relative path, libav would read the text before a colon as a protocol.
    const int code = avformat_open_input(&opened, std::filesystem::absolute(file).c_str(), nullptr, &options);
    av_dict_free(&options);
    check_read(code, file);
    input.reset(opened);
    check_read(avformat_find_stream_info(opened, nullptr), file);
    const AVCodec* decoder = nullptr;
    stream = check_read(av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0), file);
    codec.reset(avcodec_alloc_context3(decoder));
    if (!codec || !packet || !frame) fail_to_read(file, "out of memory");
    check_read(avcodec_parameters_to_context(codec.get(), opened->streams[stream]->codecpar), file);
    check_read(avcodec_open2(codec.get(), decoder, nullptr), file);
    if (codec->width < 1 || codec->height < 1) fail_to_read(file, "it does not tell its size");
    const AVDictionaryEntry* entry = nullptr;
    while ((entry = av_dict_get(opened->metadata, "", entry, AV_DICT_IGNORE_SUFFIX)))
      metadata[lower_case(entry->key)] = entry->value;
  }

  // Sends the next packet of the stream to the decoder, or signals the end of the file.
  void send_next_packet() {
    for (;;) {
      const int code = av_read_frame(input.get(), packet.get());
      if (code == AVERROR_EOF) {
        at_end = true;
        check_read(avcodec_send_packet(codec.get(), nullptr), file);
        return;
      }
      check_read(code, file);
      const bool is_video_packet = packet->stream_index == stream;
      const int sent = is_video_packet ? avcodec_send_packet(codec.get(), packet.get()) : 0;
      av_packet_unref(packet.get());
      check_read(sent, file);
      if (is_video_packet) return;
    }
  }

  image::Image convert() {
    const std::array<int, 3> shape{frame->width, frame->height, frame->format};
    if (!scaler) {
      scaler = make_scaler(*frame, file);
      first_shape = shape;
    }
    // libav changes the size in `codec`, too; the scaler keeps that of the first frame.
    if (shape != first_shape) fail_to_read(file, "its pictures change size or pixel format");
    image::Image image(frame->width, frame->height);
    std::uint8_t* const planes[4] = {image.rgb.data()};  // swscale reads four pointers
    const int strides[4] = {3 * image.width};
    check_read(sws_scale(scaler.get(), frame->data, frame->linesize, 0, frame->height, planes, strides), file);
    return image;
  }
};

Decoder::Decoder(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
Decoder::~Decoder() = default;

int Decoder::width() const {
  return impl_->codec->width;
}

int Decoder::height() const {
  return impl_->codec->height;
}

bool Decoder::lossy() const {
  const AVCodecDescriptor* codec = avcodec_descriptor_get(impl_->codec->codec_id);
  const bool lossless = codec && codec->props & AV_CODEC_PROP_LOSSLESS;
  if (!lossless || !(codec->props & AV_CODEC_PROP_LOSSY)) return !lossless;
  // H.264 can be lossy or lossless. Weft writes RGB in H.264 only if the video is lossless.
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(impl_->codec->pix_fmt);
  return !(format && format->flags & AV_PIX_FMT_FLAG_RGB);
}

std::optional<Codec> Decoder::codec() const {
  switch (impl_->codec->codec_id) {
    case AV_CODEC_ID_H264:
      return lossy() ? Codec::h264 : Codec::h264_lossless;
    case AV_CODEC_ID_FFV1:
      return Codec::ffv1;
    case AV_CODEC_ID_PRORES:
      return Codec::prores;
    default:
      return std::nullopt;
  }
}

double Decoder::fps() const {
  const AVRational rate = impl_->input->streams[impl_->stream]->avg_frame_rate;
  return rate.den == 0 ? 0 : av_q2d(rate);  // libav gives 0/0 if the rate is unknown
}

const std::map<std::string, std::string>& Decoder::metadata() const {
  return impl_->metadata;
}

std::optional<image::Image> Decoder::next() {
  for (;;) {
    const int code = avcodec_receive_frame(impl_->codec.get(), impl_->frame.get());
    if (code == 0) return impl_->convert();
    if (code == AVERROR_EOF) return std::nullopt;
    if (code != AVERROR(EAGAIN)) check_read(code, impl_->file);
    if (impl_->at_end) return std::nullopt;
    impl_->send_next_packet();
  }
}

}  // namespace weft::video
