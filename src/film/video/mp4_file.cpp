#include "film/video/mp4_file.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/temporary_file.hpp"

namespace weft::video {
namespace {

// Without use_metadata_tags, libav drops all metadata keys except those of iTunes.
constexpr const char* kFragmentedFlags = "+frag_every_frame+empty_moov+default_base_moof+use_metadata_tags";
constexpr const char* kFastStartFlags = "+faststart+use_metadata_tags";

/// Name of the container in libav. `file`: the name that the user gave, whose extension selects the container.
const char* container_of(const std::filesystem::path& file) {
  const std::filesystem::path ending = file.extension();
  return ending == ".mkv" ? "matroska" : ending == ".mov" ? "mov" : "mp4";
}
bool is_matroska(const std::filesystem::path& file) {
  return file.extension() == ".mkv";
}

// Owns a dictionary of options for libav, which replaces `entries` when it reads them.
struct Dictionary {
  AVDictionary* entries = nullptr;
  Dictionary() = default;
  ~Dictionary() { av_dict_free(&entries); }
  Dictionary(const Dictionary&) = delete;
  Dictionary& operator=(const Dictionary&) = delete;
};

InputPtr open_video(const std::filesystem::path& file, const std::filesystem::path& reported_file) {
  AVFormatContext* opened = nullptr;
  // The path is absolute, because in a relative path, libav would read the text before a colon as a protocol.
  check(avformat_open_input(&opened, std::filesystem::absolute(file).c_str(),
                            av_find_input_format(container_of(reported_file)), nullptr),
        reported_file, "read the frames back");
  InputPtr input(opened);
  if (input->nb_streams != 1) fail(reported_file, "read the frames back", "expected one stream");
  return input;
}

// Reads the next packet. Returns false at the end of the file.
bool read_packet(AVFormatContext& input, AVPacket& packet, const std::filesystem::path& reported_file) {
  const int code = av_read_frame(&input, &packet);
  if (code == AVERROR_EOF) return false;
  check(code, reported_file, "read the frames back");
  return true;
}

// Whether packets of both codecs can be in one file: an MP4 file has one codec configuration for all its packets.
bool same_codec(const AVCodecParameters& a, const AVCodecParameters& b) {
  const auto bytes = [](const AVCodecParameters& codec) {
    return std::basic_string_view<std::uint8_t>(codec.extradata, static_cast<std::size_t>(codec.extradata_size));
  };
  return a.codec_id == b.codec_id && a.width == b.width && a.height == b.height && bytes(a) == bytes(b);
}

// Delay between decoding and showing the first frame [frames]. Matroska stores no decoding times; for it, the result is
// the smallest delay with which no frame is decoded after the time at which it is shown. 0 if the file has no frame or
// a time is missing.
std::int64_t delay_of(const std::filesystem::path& file, const std::filesystem::path& reported_file, AVRational rate) {
  const InputPtr input = open_video(file, reported_file);
  const AVRational unit = input->streams[0]->time_base;
  const PacketPtr packet = check_allocated(PacketPtr(av_packet_alloc()), reported_file);
  std::int64_t delay = 0, first_time = 0;
  for (std::int64_t k = 0; read_packet(*input, *packet, reported_file); ++k) {
    if (packet->pts == AV_NOPTS_VALUE || (!is_matroska(reported_file) && packet->dts == AV_NOPTS_VALUE)) return 0;
    if (!is_matroska(reported_file)) return av_rescale_q(packet->pts - packet->dts, unit, av_inv_q(rate));
    const std::int64_t time = av_rescale_q(packet->pts, unit, av_inv_q(rate));
    if (k == 0) first_time = time;
    delay = std::max(delay, k - (time - first_time));
    av_packet_unref(packet.get());
  }
  return delay;
}

/// Reads `file`. Throws Error(output_failed) unless it contains each of `frames` frames once, frame k at time k /
/// `rate`. In Matroska, only the nearest frame number is checked, because times are rounded to milliseconds.
void verify_frames(const std::filesystem::path& file, const std::filesystem::path& reported_file, AVRational rate,
                   int frames) {
  const InputPtr input = open_video(file, reported_file);
  const AVRational unit = input->streams[0]->time_base;
  const PacketPtr packet = check_allocated(PacketPtr(av_packet_alloc()), reported_file);

  std::vector<bool> seen(static_cast<std::size_t>(frames));
  int count = 0;
  while (read_packet(*input, *packet, reported_file)) {
    const std::int64_t frame = av_rescale_q(packet->pts, unit, av_inv_q(rate));
    // Matroska rounds times to milliseconds.
    const bool on_time = is_matroska(reported_file) || av_compare_ts(packet->pts, unit, frame, av_inv_q(rate)) == 0;
    const bool new_frame = frame >= 0 && frame < frames && !seen[frame];
    if (!on_time || !new_frame) {
      fail(reported_file, "verify the frames", fmt::format("packet {} is not one of {} frames", count, frames));
    }
    seen[frame] = true;
    ++count;
    av_packet_unref(packet.get());
  }
  if (count != frames) fail(reported_file, "verify the frames", fmt::format("{} of {} are there", count, frames));
}

}  // namespace

VideoFileWriter::VideoFileWriter(const std::filesystem::path& file, std::filesystem::path reported_file,
                                 Mp4Layout layout, const AVCodecParameters& codec, AVRational rate,
                                 const std::map<std::string, std::string>& metadata)
    : reported_file_(std::move(reported_file)), frame_duration_(av_inv_q(rate)) {
  AVFormatContext* allocated = nullptr;
  check(avformat_alloc_output_context2(&allocated, nullptr, container_of(reported_file_), file.c_str()), reported_file_,
        "start a file");
  output_.reset(allocated);

  AVStream* stream = check_allocated(avformat_new_stream(output_.get(), nullptr), reported_file_);
  check(avcodec_parameters_copy(stream->codecpar, &codec), reported_file_, "describe the video");
  stream->codecpar->codec_tag = 0;  // the tag of the source container may not suit this one
  stream->time_base = frame_duration_;
  stream->avg_frame_rate = rate;
  for (const auto& [key, value] : metadata) {
    check(av_dict_set(&output_->metadata, key.c_str(), value.c_str(), 0), reported_file_, "set metadata");
  }

  // Writes each packet to the system at once. If the process is killed, only the frames inside the encoder are lost.
  output_->flags |= AVFMT_FLAG_FLUSH_PACKETS;
  // Without this flag, Matroska files contain random numbers, and equal runs would not give equal bytes.
  if (is_matroska(reported_file_)) output_->flags |= AVFMT_FLAG_BITEXACT;
  check(avio_open(&output_->pb, output_->url, AVIO_FLAG_WRITE), reported_file_, "create the file");
  Dictionary options;
  const char* flags = layout == Mp4Layout::fragmented ? kFragmentedFlags : kFastStartFlags;
  // Matroska needs no flags: incomplete files are playable.
  if (!is_matroska(reported_file_))
    check(av_dict_set(&options.entries, "movflags", flags, 0), reported_file_, "choose the layout of the file");
  check(avformat_write_header(output_.get(), &options.entries), reported_file_, "write the header");
  if (av_dict_count(options.entries) != 0) fail(reported_file_, "write the header", "libav ignores movflags");
}

void VideoFileWriter::write(AVPacket& packet) {
  packet.stream_index = 0;
  packet.pos = -1;
  packet.duration = 1;
  av_packet_rescale_ts(&packet, frame_duration_, output_->streams[0]->time_base);
  check(av_write_frame(output_.get(), &packet), reported_file_, "write a frame");
}

void VideoFileWriter::close() {
  check(av_write_trailer(output_.get()), reported_file_, "write the index");
  check(avio_closep(&output_->pb), reported_file_, "close the file");
  output_.reset();
}

void join_packets(std::span<const std::filesystem::path> from, const std::filesystem::path& file, AVRational rate,
                  int frames, const std::map<std::string, std::string>& metadata) {
  TemporaryFile whole(file);
  const InputPtr first = open_video(from.front(), file);
  const AVCodecParameters& codec = *first->streams[0]->codecpar;
  VideoFileWriter writer(whole.path(), file, Mp4Layout::fast_start, codec, rate, metadata);
  const PacketPtr packet = check_allocated(PacketPtr(av_packet_alloc()), file);

  // Packet k is decoded `delay` frames before time k, because B-frames need later frames. Files may differ in this
  // delay (it is 0 for a file of one frame), so the largest delay is used.
  std::int64_t delay = 0;
  for (const std::filesystem::path& part : from) delay = std::max(delay, delay_of(part, file, rate));

  std::int64_t written = 0;
  for (const std::filesystem::path& part : from) {
    const InputPtr input = open_video(part, file);
    const AVStream& stream = *input->streams[0];
    if (!same_codec(codec, *stream.codecpar))
      fail(file, fmt::format("join {}", part.string()), "it is not encoded as the first one is");
    // A fragmented file cannot contain negative times, so libav has shifted all times by the delay. This loop subtracts
    // the time of the first packet. This packet is frame 0 of its file, because each stream starts with a key frame.
    const std::int64_t before = written;
    std::optional<std::int64_t> first_time;
    for (; read_packet(*input, *packet, file); ++written) {
      av_packet_rescale_ts(packet.get(), stream.time_base, av_inv_q(rate));
      if (!first_time) first_time = packet->pts;
      packet->pts += before - *first_time;
      packet->dts = written - delay;
      writer.write(*packet);
      av_packet_unref(packet.get());
    }
  }
  writer.close();
  verify_frames(whole.path(), file, rate, frames);
  whole.commit();
}

}  // namespace weft::video
