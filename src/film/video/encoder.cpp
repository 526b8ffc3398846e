#include "film/video/encoder.hpp"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/temporary_file.hpp"
#include "film/video/frame_converter.hpp"
#include "film/video/frame_rate.hpp"
#include "film/video/libav.hpp"
#include "film/video/mp4_file.hpp"

namespace weft::video {
namespace {

constexpr const char* kCodecName = "libx264";

/// Names of a codec and its encoder, the pixel format, and the file extensions that the codec allows.
struct CodecKind {
  Codec codec;
  const char *name, *encoder;
  AVPixelFormat format;
  std::vector<std::string> endings;
};
const std::vector<CodecKind>& codec_kinds() {
  // H.264 must be the first row, because is_written() uses its extensions, which include those of all other codecs.
  static const std::vector<CodecKind> kKinds{
      {Codec::h264, "h264", kCodecName, AV_PIX_FMT_YUV420P, {".mp4", ".mov", ".mkv"}},
      {Codec::h264_lossless, "h264_lossless", "libx264rgb", AV_PIX_FMT_RGB24, {".mkv", ".mp4", ".mov"}},
      {Codec::ffv1, "ffv1", "ffv1", AV_PIX_FMT_BGR0, {".mkv"}},
      {Codec::prores, "prores", "prores_ks", AV_PIX_FMT_YUV422P10, {".mov", ".mkv"}}};
  return kKinds;
}
const CodecKind& kind_of(Codec codec) {
  return *std::ranges::find(codec_kinds(), codec, &CodecKind::codec);
}
constexpr int kMaxSide = 16384;  // [pixels]; limit of x264

constexpr std::array<std::string_view, 10> kPresets = {"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                                       "medium",    "slow",      "slower",   "veryslow", "placebo"};

// Number of frames from one key frame to the next: those of two seconds, because players seek only to key frames; at
// least 12, at most 250 (the default of x264).
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
  // A crf of 0 is lossless, in a profile that browsers do not play.
  require(settings.crf >= 1 && settings.crf <= 51, "crf", "1 to 51", settings.crf);
  // The number 0 would mean one thread per core, so that the output would depend on the machine.
  require(settings.threads >= 1 && settings.threads <= 128, "encoder threads", "1 to 128", settings.threads);
  if (std::find(kPresets.begin(), kPresets.end(), settings.preset) == kPresets.end()) {
    throw Error(ExitCode::output_failed, "{}: preset: expected one of {}, got {}", file.string(),
                fmt::join(kPresets, ", "), settings.preset);
  }
}

CodecPtr open_codec(const std::filesystem::path& file, const Settings& settings, const AVFrame& format,
                    AVRational rate) {
  const CodecKind& kind = kind_of(settings.codec);
  const AVCodec* codec = avcodec_find_encoder_by_name(kind.encoder);
  if (!codec)
    fail(file, fmt::format("encode {}", kind.name),
         fmt::format("this libavcodec has no {}; install Debian's libavcodec59", kind.encoder));
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
  context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // MP4 stores the parameters of the stream in its header
  const bool x264 = settings.codec == Codec::h264 || settings.codec == Codec::h264_lossless;
  if (x264) check(av_opt_set(context->priv_data, "preset", settings.preset.c_str(), 0), file, "choose the x264 preset");
  switch (settings.codec) {
    case Codec::h264:
      check(av_opt_set_double(context->priv_data, "crf", settings.crf, 0), file, "choose the quality");
      // The macroblock tree of x264 (build 164) reads uninitialised memory for most picture sizes, so that equal
      // pictures give different bits. (Measured at the same crf and 1280x720: without the tree, a film is 38 % larger
      // and its frames are 0.5 dB closer to the originals.)
      check(av_opt_set_int(context->priv_data, "mbtree", 0, 0), file, "choose the rate control");
      break;
    case Codec::h264_lossless:
      check(av_opt_set_int(context->priv_data, "qp", 0, 0), file, "choose the quality");
      break;
    case Codec::ffv1:
      context->level = 3;     // slices with checksums
      context->gop_size = 1;  // every frame is a key frame
      break;
    default:
      check(av_opt_set(context->priv_data, "profile", "hq", 0), file, "choose the profile");
      check(av_opt_set(context->priv_data, "vendor", "apl0", 0), file, "choose the profile");
  }
  check(avcodec_open2(context.get(), codec, nullptr), file, "start the encoder");
  return context;
}

}  // namespace

struct Encoder::Impl {
  std::filesystem::path file;
  Settings settings;
  AVRational rate;
  std::optional<TemporaryFile> fragments;  // kept until finish() has made the whole file from them
  FrameConverter converter;
  FramePtr frame;
  PacketPtr packet;
  CodecPtr codec;
  std::unique_ptr<VideoFileWriter> writer;
  int frames = 0;   // number of frames sent to the encoder
  int packets = 0;  // number of packets received from the encoder
  bool finished = false;

  Impl(const std::filesystem::path& f, const Settings& s);
  void send(const AVFrame* next);
};

Encoder::Impl::Impl(const std::filesystem::path& f, const Settings& s)
    : file(f),
      settings(s),
      rate(frame_rate(s.fps)),
      fragments(std::in_place, partial_name(f)),
      converter(s.width, s.height, f, kind_of(s.codec).format),
      frame(converter.make_frame()),
      packet(check_allocated(PacketPtr(av_packet_alloc()), f)),
      codec(open_codec(f, s, *frame, rate)) {
  const ParametersPtr parameters = check_allocated(ParametersPtr(avcodec_parameters_alloc()), file);
  check(avcodec_parameters_from_context(parameters.get(), codec.get()), file, "describe the video");
  writer = std::make_unique<VideoFileWriter>(fragments->path(), file, Mp4Layout::fragmented, *parameters, rate,
                                             settings.metadata);
}

// Sends a frame to the encoder, or nullptr to end the video, and writes the packets that are ready.
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

Encoder::Encoder(const std::filesystem::path& file, const Settings& wanted) {
  Settings settings = wanted;
  settings.codec = codec_of(file, wanted.codec);
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
  // x264 may still use the previous frame.
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
    join_packets({&self.fragments->path(), 1}, self.file, self.rate, self.frames, self.settings.metadata);
    self.fragments.reset();
  } catch (const Error& error) {
    // The copy needs additional disk space. The fragments are complete and playable, so they are kept.
    self.fragments->commit();
    throw Error(error.code(), "{}; all {} frames are kept in {}", error.what(), self.frames,
                partial_name(self.file).string());
  }
}

int Encoder::frames() const {
  return impl_->frames;
}

bool is_written(const std::string& ending) {
  const std::vector<std::string>& all = codec_kinds().front().endings;
  return std::ranges::find(all, ending) != all.end();
}

Codec codec_of(const std::filesystem::path& file, Codec codec) {
  const std::string ending = file.extension().string();
  if (codec == Codec::automatic) return ending == ".mov" ? Codec::prores : ending == ".mkv" ? Codec::ffv1 : Codec::h264;
  const CodecKind& kind = kind_of(codec);
  if (std::ranges::find(kind.endings, ending) == kind.endings.end())
    throw Error(ExitCode::usage, "--codec: {} is kept in files ending in {}, got {}", kind.name,
                fmt::join(kind.endings, " or "), file.string());
  return codec;
}

std::filesystem::path partial_name(const std::filesystem::path& file) {
  return std::filesystem::path(file).replace_filename(file.stem().string() + ".partial" + file.extension().string());
}

std::string encoder_description() {
  const unsigned version = avcodec_version();
  if (!avcodec_find_encoder_by_name(kCodecName)) return "none: libavcodec was built without libx264";
  return fmt::format("{} through libavcodec {}.{}.{} (FFmpeg {})", kCodecName, AV_VERSION_MAJOR(version),
                     AV_VERSION_MINOR(version), AV_VERSION_MICRO(version), av_version_info());
}

}  // namespace weft::video
