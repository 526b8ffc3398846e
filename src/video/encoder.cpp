#include "video/encoder.hpp"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "core/temporary_file.hpp"
#include "video/frame_converter.hpp"
#include "video/frame_rate.hpp"
#include "video/libav.hpp"
#include "video/mp4_file.hpp"

namespace weft::video {
namespace {

constexpr const char* kCodecName = "libx264";
constexpr int kMaxSide = 16384;  // pixels; the limit of x264

constexpr std::array<std::string_view, 10> kPresets = {"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                                       "medium",    "slow",      "slower",   "veryslow", "placebo"};

// Players jump to key frames only, so one every two seconds keeps a video pleasant to step through. Bounded for very
// slow and very fast rates; 250 is x264's own default.
int key_frame_distance(double fps) {
  return std::clamp(static_cast<int>(std::lround(2 * fps)), 12, 250);
}

void check_settings(const std::filesystem::path& file, const Settings& settings) {
  const auto require = [&](bool good, const char* name, const std::string& expected, int got) {
    if (!good) throw Error(ExitCode::output_failed, "{}: {}: expected {}, got {}", file.string(), name, expected, got);
  };
  const std::string sides = fmt::format("1 to {} pixels", kMaxSide);
  require(settings.width >= 1 && settings.width <= kMaxSide, "width", sides, settings.width);
  require(settings.height >= 1 && settings.height <= kMaxSide, "height", sides, settings.height);
  // 0 is lossless, in a profile that browsers do not play.
  require(settings.crf >= 1 && settings.crf <= 51, "crf", "1 to 51", settings.crf);
  // 0 would take the machine's cores, and the bytes would follow the machine.
  require(settings.threads >= 1 && settings.threads <= 128, "encoder threads", "1 to 128", settings.threads);
  if (std::find(kPresets.begin(), kPresets.end(), settings.preset) == kPresets.end()) {
    throw Error(ExitCode::output_failed, "{}: preset: expected one of {}, got {}", file.string(),
                fmt::join(kPresets, ", "), settings.preset);
  }
}

CodecPtr open_codec(const std::filesystem::path& file, const Settings& settings, const AVFrame& format,
                    AVRational rate) {
  const AVCodec* codec = avcodec_find_encoder_by_name(kCodecName);
  if (!codec) fail(file, "encode H.264", "this libavcodec has no libx264; install Debian's libavcodec59");
  CodecPtr context = check_allocated(CodecPtr(avcodec_alloc_context3(codec)), file);
  context->width = format.width;
  context->height = format.height;
  context->pix_fmt = static_cast<AVPixelFormat>(format.format);
  context->color_range = format.color_range;
  context->colorspace = format.colorspace;
  context->color_primaries = format.color_primaries;
  context->color_trc = format.color_trc;
  context->chroma_sample_location = format.chroma_location;
  context->sample_aspect_ratio = {1, 1};
  context->framerate = rate;
  context->time_base = av_inv_q(rate);
  context->gop_size = key_frame_distance(settings.fps);
  context->thread_count = settings.threads;
  context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // MP4 keeps the stream's parameters in its header
  check(av_opt_set(context->priv_data, "preset", settings.preset.c_str(), 0), file, "choose the x264 preset");
  check(av_opt_set_double(context->priv_data, "crf", settings.crf, 0), file, "choose the quality");
  check(avcodec_open2(context.get(), codec, nullptr), file, "start x264");
  return context;
}

}  // namespace

struct Encoder::Impl {
  std::filesystem::path file;
  Settings settings;
  AVRational rate;
  std::optional<TemporaryFile> fragments;  // until the finished file is made out of them
  FrameConverter converter;
  FramePtr frame;
  PacketPtr packet;
  CodecPtr codec;
  std::unique_ptr<Mp4Writer> writer;
  int frames = 0;   // given to the encoder
  int packets = 0;  // got back from it
  bool finished = false;

  Impl(const std::filesystem::path& f, const Settings& s);
  void send(const AVFrame* next);
  void publish();
};

Encoder::Impl::Impl(const std::filesystem::path& f, const Settings& s)
    : file(f),
      settings(s),
      rate(frame_rate(s.fps)),
      fragments(std::in_place, partial_name(f)),
      converter(s.width, s.height, f),
      frame(converter.make_frame()),
      packet(check_allocated(PacketPtr(av_packet_alloc()), f)),
      codec(open_codec(f, s, *frame, rate)) {
  const ParametersPtr parameters = check_allocated(ParametersPtr(avcodec_parameters_alloc()), file);
  check(avcodec_parameters_from_context(parameters.get(), codec.get()), file, "describe the video");
  writer =
      std::make_unique<Mp4Writer>(fragments->path(), file, Mp4Layout::fragmented, *parameters, rate, settings.metadata);
}

// Gives the encoder a frame, or nullptr for the end, and writes the packets that are ready.
void Encoder::Impl::send(const AVFrame* next) {
  check(avcodec_send_frame(codec.get(), next), file, "encode a frame");
  while (true) {
    const int code = avcodec_receive_packet(codec.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    check(code, file, "encode a frame");
    writer->write(*packet);
    av_packet_unref(packet.get());
    ++packets;
  }
}

// Makes the finished file out of the fragments.
void Encoder::Impl::publish() {
  TemporaryFile whole(file);
  copy_to_fast_start({&fragments->path(), 1}, whole.path(), file, rate, settings.metadata);
  verify_frames(whole.path(), file, rate, frames);
  whole.commit();
}

Encoder::Encoder(const std::filesystem::path& file, const Settings& settings) {
  collect_log();
  check_settings(file, settings);
  check_writable(file);
  impl_ = std::make_unique<Impl>(file, settings);
}

Encoder::~Encoder() = default;

void Encoder::add(const image::Image& image) {
  Impl& self = *impl_;
  if (self.finished) throw Error(ExitCode::internal, "{}: a frame came after the end", self.file.string());
  if (image.width != self.settings.width || image.height != self.settings.height) {
    throw Error(ExitCode::internal, "{}: frame {}: expected {}x{} pixels, got {}x{}", self.file.string(), self.frames,
                self.settings.width, self.settings.height, image.width, image.height);
  }
  // x264 may still hold the frame before.
  check(av_frame_make_writable(self.frame.get()), self.file, "get memory for a frame");
  self.converter.convert(image, *self.frame);
  self.frame->pts = self.frames++;
  self.send(self.frame.get());
}

void Encoder::finish() {
  Impl& self = *impl_;
  if (self.finished) throw Error(ExitCode::internal, "{}: finished twice", self.file.string());
  if (self.frames == 0)
    throw Error(ExitCode::output_failed, "{}: expected one frame or more, got none", self.file.string());
  self.finished = true;
  self.send(nullptr);
  if (self.packets != self.frames) {
    fail(self.file, "encode", fmt::format("{} frames gave {} packets", self.frames, self.packets));
  }
  self.writer->close();
  try {
    self.publish();
    self.fragments.reset();
  } catch (const Error& error) {
    // The copy needs its own room on the disk. The fragments are whole and play, so they are not thrown away.
    self.fragments->commit();
    throw Error(error.code(), "{}; all {} frames are kept in {}", error.what(), self.frames,
                partial_name(self.file).string());
  }
}

int Encoder::frames() const {
  return impl_->frames;
}

std::filesystem::path partial_name(const std::filesystem::path& file) {
  return std::filesystem::path(file).replace_filename(file.stem().string() + ".partial.mp4");
}

std::string encoder_description() {
  const unsigned version = avcodec_version();
  if (!avcodec_find_encoder_by_name(kCodecName)) return "none: libavcodec was built without libx264";
  return fmt::format("{} through libavcodec {}.{}.{} (FFmpeg {})", kCodecName, AV_VERSION_MAJOR(version),
                     AV_VERSION_MINOR(version), AV_VERSION_MICRO(version), av_version_info());
}

}  // namespace weft::video
