#include "cli/output_target.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <regex>

#include "core/error.hpp"
#include "core/temporary_file.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void bad_pattern(std::string_view text) {
  throw Error(ExitCode::usage, "-o: expected one {{frame}} or {{frame:05}} in the name of the pictures, got {}", text);
}

// The number of digits in what stands between the braces: "frame", "frame:5" or "frame:05".
int parse_digits(std::string_view field, std::string_view text) {
  if (field == "frame") return 1;
  if (field.substr(0, 6) != "frame:") bad_pattern(text);
  field.remove_prefix(6);
  int digits = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), digits);
  if (error != std::errc() || end != field.data() + field.size() || digits < 1 || digits > 10) bad_pattern(text);
  return digits;
}

}  // namespace

FramePattern::FramePattern(std::string_view text) {
  const std::size_t open = text.find('{'), close = text.find('}');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) bad_pattern(text);
  before_ = text.substr(0, open);
  after_ = text.substr(close + 1);
  if (after_.find_first_of("{}") != std::string::npos) bad_pattern(text);
  digits_ = parse_digits(text.substr(open + 1, close - open - 1), text);
}

fs::path FramePattern::name(int frame) const {
  return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

fs::path OutputTarget::file(int frame) const {
  return kind == Kind::images ? FramePattern(text).name(frame) : fs::path(text);
}

OutputTarget parse_output(const std::string& text, const std::string& scene_name) {
  if (text.empty()) return {OutputTarget::Kind::video, (fs::path("output") / (scene_name + ".mp4")).string()};
  const std::string ending = fs::path(text).extension().string();
  if (ending == ".mp4") {
    if (text.find_first_of("{}") != std::string::npos) {
      throw Error(ExitCode::usage, "-o: a video holds all frames, so its name has no {{frame}}, got {}", text);
    }
    return {OutputTarget::Kind::video, text};
  }
  if (ending == ".png") {
    (void)FramePattern(text);  // checked now, not at the first picture
    return {OutputTarget::Kind::images, text};
  }
  throw Error(ExitCode::usage, "-o: expected a name ending in .mp4, or in .png with {{frame:05}} in it, got {}", text);
}

void check_writable(const fs::path& file) {
  const TemporaryFile temporary(file);
  std::FILE* out = std::fopen(temporary.path().c_str(), "wbe");
  if (out == nullptr) {
    throw Error(ExitCode::output_failed, "{}: cannot be written: {}", file.string(), std::strerror(errno));
  }
  std::fclose(out);
}

void check_absent(const fs::path& file, bool overwrite) {
  std::error_code ignored;  // what cannot be looked at is found by check_writable
  if (fs::is_directory(file, ignored)) {
    throw Error(ExitCode::output_failed, "{}: is a folder, expected a file name", file.string());
  }
  if (!overwrite && fs::exists(file, ignored)) {
    throw Error(ExitCode::output_failed, "{}: exists already; give --overwrite to replace it, or another name",
                file.string());
  }
}

void remove_half_files(const fs::path& folder, const std::set<std::string>& names) {
  static const std::regex kTemporary(R"(\.(.+)\.[0-9]+\.tmp)");  // as TemporaryFile names them
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::smatch match;
    std::error_code ignored;
    if (std::regex_match(name, match, kTemporary) && names.contains(match[1])) fs::remove(entry->path(), ignored);
  }
}

void prepare_output(const OutputTarget& target, const FrameRange& frames, bool overwrite) {
  const bool video = target.kind == OutputTarget::Kind::video;
  for (int frame = frames.begin; frame < frames.end; frame += frames.step) {
    check_absent(target.file(frame), overwrite);
    if (video) break;
  }
  check_writable(target.file(frames.begin));
}

}  // namespace weft::cli
