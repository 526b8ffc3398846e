// weft join: joins parts of a film, which several machines may have drawn, to one video. It identifies each part by its
// metadata, not by its name.
#include "film/video/join.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/log.hpp"
#include "film/image/png.hpp"
#include "film/scene/scene.hpp"
#include "film/video/decoder.hpp"
#include "film/video/encoder.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/option_values.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/signals.hpp"
#include "tools/cli/stages.hpp"
#include "tools/compare/files.hpp"
#include "tools/compare/references.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

/// A picture file, or a video with some frames of the film.
struct Piece {
  fs::path file;
  std::vector<int> frames = {};  ///< frame numbers, ascending
  int step = 1;                  ///< distance between frame numbers
  int width = 0, height = 0;
  Metadata film = {};   ///< metadata that all pieces of a film share
  std::string gl = {};  ///< OpenGL description of the machine that drew it
};

bool is_video(const fs::path& file) {
  return file.extension() == ".mp4";
}

const std::string& entry(const fs::path& file, const Metadata& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  if (found == metadata.end())
    throw Error(ExitCode::usage, "{}: expected a file drawn by Weft, which stores its {}; this one does not",
                file.string(), key);
  return found->second;
}

template <class Number>
Number number(const fs::path& file, const Metadata& metadata, const std::string& key, Number least = 0,
              Number most = std::numeric_limits<Number>::max()) {
  const std::string& text = entry(file, metadata, key);
  const auto value = number_in<Number>(text);
  if (!value || !(*value >= least && *value <= most))
    throw Error(ExitCode::usage, "{}: expected a file drawn by Weft; its {} is '{}'", file.string(), key, text);
  return *value;
}

double fps_of(const fs::path& file, const Metadata& metadata) {
  return number<double>(file, metadata, "fps", std::numeric_limits<double>::min());
}

int scene_frames_of(const fs::path& file, const Metadata& metadata) {
  return number<int>(file, metadata, "scene_frames", 1, scene::kMaxFrames + 1);
}

// Checks a time or a frame rate. The tolerance allows for broadcast rates such as 30000/1001, which differ from their
// decimals (29.97) by up to 1.1e-6 of the rate.
void check_time(const fs::path& file, double found, double expected, const char* what) {
  if (std::abs(found - expected) <= 1e-5 * std::max(1.0, expected)) return;
  throw Error(ExitCode::usage, "{}: expected {} {:g}, got {:g}", file.string(), what, expected, found);
}

Piece read_picture(const fs::path& file) {
  Piece piece{.file = file};
  const image::Image image = image::read_png(file, &piece.film);
  piece.width = image.width;
  piece.height = image.height;
  const int frame = number<int>(file, piece.film, "frame");
  const double fps = fps_of(file, piece.film);
  piece.frames = {frame};
  check_time(file, number<double>(file, piece.film, "time_s"), frame / fps, "the time of its frame [s]");
  return piece;
}

// Decodes the whole video. Frames that the metadata name but the video lacks count as missing. If a
// frame cannot be decoded, the whole video counts as unreadable.
Piece read_video(const fs::path& file) {
  video::Decoder decoder(file);
  Piece piece{.file = file, .width = decoder.width(), .height = decoder.height(), .film = decoder.metadata()};
  const double fps = fps_of(file, piece.film);
  const FrameRange range =
      resolve_frames(parse_frames(entry(file, piece.film, "frames")), scene_frames_of(file, piece.film));
  piece.step = range.step;
  check_time(file, decoder.fps(), fps / range.step, "frames a second");
  for (int frame = range.begin; frame < range.end && decoder.next(); frame += range.step) piece.frames.push_back(frame);
  return piece;
}

Piece read_piece(const fs::path& file) {
  Piece piece = is_video(file) ? read_video(file) : read_picture(file);
  piece.gl = piece.film["gl"];
  // Removes metadata that only concern this piece or its file format.
  for (const char* own : {"gl", "frame", "time_s", "frames", "major_brand", "minor_version", "compatible_brands",
                          "encoder", "creation_time"})
    piece.film.erase(own);
  return piece;
}

std::vector<fs::path> files_of(const fs::path& part) {
  if (is_video(part) && !fs::is_directory(part)) return {part};
  if (!fs::is_directory(part))
    throw Error(ExitCode::usage, "{}: expected a video (.mp4) or a folder of pictures", part.string());
  std::vector<fs::path> files;
  for (const std::string& name : compare::comparable_names(part))
    if (!compare::is_video(name) && name.find('/') == std::string::npos) files.push_back(part / name);
  if (files.empty()) throw Error(ExitCode::asset_unreadable, "{}: holds no pictures", part.string());
  return files;
}

/// All pieces of a film, ordered by frame. The constructor checks that the pieces fit together.
class Film {
 public:
  explicit Film(const std::vector<fs::path>& parts) {
    for (const fs::path& part : parts)
      for (const fs::path& file : files_of(part)) add(file);
    if (pieces_.empty()) throw Error(ExitCode::frames_missing, "{}", problem_);
    std::ranges::sort(pieces_, {}, [](const Piece& piece) { return piece.frames.front(); });
    for (const Piece& piece : pieces_) check_fits(piece);
  }

  const std::vector<Piece>& pieces() const { return pieces_; }
  const Piece& first() const { return pieces_.front(); }
  bool of_videos() const { return is_video(first().file); }

  /// Returns the requested frames if none is missing and every file is readable; otherwise throws
  /// Error(frames_missing) with the numbers of the missing frames. With `partial`, warns instead,
  /// and returns the frames before the first missing one; if no frame is before it, throws
  /// nevertheless.
  FrameRange frames(const JoinOptions& options) const;

 private:
  void add(const fs::path& file) {
    try {
      Piece piece = read_piece(file);
      if (piece.frames.empty()) throw Error(ExitCode::asset_unreadable, "{}: holds no pictures", file.string());
      pieces_.push_back(std::move(piece));
    } catch (const Error& error) {
      if (error.code() != ExitCode::asset_unreadable) throw;
      if (problem_.empty()) problem_ = error.what();
    }
  }

  void check_fits(const Piece& piece) {
    const auto refuse = [&](const std::string& what, const std::string& here, const std::string& there) {
      throw Error(ExitCode::usage, "{}: expected parts of one video; its {} is '{}', that of {} is '{}'",
                  piece.file.string(), what, here, first().file.string(), there);
    };
    if (is_video(piece.file) != of_videos())
      throw Error(ExitCode::usage, "expected either videos or folders of pictures, got both: {} and {}",
                  first().file.string(), piece.file.string());
    for (const auto& [key, value] : first().film)
      if (const auto here = piece.film.find(key); here == piece.film.end() || here->second != value)
        refuse(key, here == piece.film.end() ? "" : here->second, value);
    if (piece.film.size() != first().film.size()) refuse("metadata", "more", "less");
    const auto size = [](const Piece& p) { return fmt::format("{}x{}", p.width, p.height); };
    if (size(piece) != size(first())) refuse("size", size(piece), size(first()));
    if (piece.step != first().step) refuse("step", fmt::format("{}", piece.step), fmt::format("{}", first().step));
    for (const int frame : piece.frames)
      if (const auto [other, is_new] = where_.emplace(frame, piece.file); !is_new)
        throw Error(ExitCode::usage, "frame {} is in both {} and {}", frame, other->second.string(),
                    piece.file.string());
  }

  std::vector<Piece> pieces_;
  std::map<int, fs::path> where_;  // file of each frame
  std::string problem_;            // message of the first unreadable file
};

FrameRange Film::frames(const JoinOptions& options) const {
  FrameSelection selection = options.frames;
  if (of_videos() && selection.step == 1) selection.step = first().step;
  const FrameRange wanted = resolve_frames(selection, scene_frames_of(first().file, first().film));
  FrameRange before{wanted.begin, wanted.begin, wanted.step};  // frames before the first missing one
  std::vector<int> missing;
  for (int frame = wanted.begin; frame < wanted.end; frame += wanted.step) {
    if (!where_.contains(frame)) missing.push_back(frame);
    if (missing.empty()) before.end = frame + 1;
  }
  if (missing.empty() && problem_.empty()) return wanted;
  std::string text = fmt::format("of frames {}", wanted.text());
  if (!missing.empty())
    text += fmt::format(" frame{} {} missing", missing.size() == 1 ? "" : "s",
                        frames_text(missing) + (missing.size() == 1 ? " is" : " are"));
  if (!problem_.empty()) text += fmt::format("{} {}", missing.empty() ? " all are there, but" : ";", problem_);
  if (!options.partial || before.end == before.begin)
    throw Error(ExitCode::frames_missing, "{}; --partial uses the frames before the first missing one", text);
  log::warn(fmt::format("{}; only {} are used", text, before.text()));
  return missing.empty() ? wanted : before;
}

/// The files with these frames, in order. Throws Error(usage) if a video has other frames too.
std::vector<fs::path> files_of(const Film& film, const FrameRange& frames) {
  std::vector<fs::path> files;
  for (const Piece& piece : film.pieces()) {
    const auto inside = std::ranges::count_if(piece.frames, [&](int frame) { return frames.contains(frame); });
    if (inside == static_cast<std::ptrdiff_t>(piece.frames.size())) {
      files.push_back(piece.file);
    } else if (inside > 0) {
      throw Error(ExitCode::usage, "{}: only some of its frames are in {}; a video can only be joined whole",
                  piece.file.string(), frames.text());
    }
  }
  return files;
}

Metadata describe(const Film& film, const FrameRange& frames) {
  Metadata metadata = film.first().film;
  metadata["frames"] = frames.text();
  const bool one_machine =
      std::ranges::all_of(film.pieces(), [&](const Piece& piece) { return piece.gl == film.first().gl; });
  metadata["gl"] = one_machine ? film.first().gl : "several";
  return metadata;
}

/// Encodes the pictures as one video. If interrupted, leaves no file and throws Error(interrupted).
void encode(const std::vector<fs::path>& pictures, const fs::path& file, const video::Settings& settings) {
  const StopSignals signals;
  video::Encoder encoder(file, settings);
  for (const fs::path& picture : pictures) {
    if (signals.requested()) throw Error(ExitCode::interrupted, "interrupted; no video was written");
    encoder.add(image::read_png(picture));
  }
  encoder.finish();
}

}  // namespace

ExitCode join(const JoinOptions& options) {
  if (!video::is_written(options.output.extension().string()))
    throw Error(ExitCode::usage, "-o: expected a name ending in .mp4, .mov or .mkv, got {}", options.output.string());
  const video::Codec codec = codec_of(options.output, options.video);
  const Film film(options.parts);
  if (film.of_videos() && (!is_video(options.output) || options.video.any()))
    throw Error(ExitCode::usage,
                "{}: videos are joined as they are, into .mp4; other endings, --codec and --crf are for pictures",
                options.output.string());
  const FrameRange frames = film.frames(options);
  const std::vector<fs::path> files = files_of(film, frames);
  PathLedger paths;
  for (const fs::path& file : files) paths.reads(file, "a part of the film");
  paths.writes("-o", options.output);
  if (!film.of_videos()) paths.writes("-o", video::partial_name(options.output));
  paths.check_absent(options.overwrite);
  paths.check_writable();
  const double fps = fps_of(film.first().file, film.first().film) / frames.step;
  const Metadata metadata = describe(film, frames);
  if (film.of_videos()) {
    video::join_videos(files, options.output, fps, frames.count(), metadata);
  } else {
    video::Settings settings;
    settings.width = film.first().width;
    settings.height = film.first().height;
    settings.fps = fps;
    settings.codec = codec;
    settings.crf = options.video.crf.value_or(settings.crf);
    settings.metadata = metadata;
    encode(files, options.output, settings);
    const auto scene = metadata.find("scene");
    if (scene != metadata.end()) remove_kept_frames(options.output, scene->second);
  }
  log::info(fmt::format("{}: frames {} from {} file{}", options.output.string(), frames.text(), files.size(),
                        files.size() == 1 ? "" : "s"));
  return ExitCode::ok;
}

}  // namespace weft::cli
