#include "tools/cli/frame_range.hpp"

#include "core/error.hpp"
#include "tools/cli/option_values.hpp"

namespace weft::cli {
namespace {

constexpr std::string_view kExpected =
    "expected A:B or A:B:STEP for frames A to B - 1, counted from 0, such as 0:50 or 10:100:2";

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos; colon = text.find(':')) {
    parts.push_back(text.substr(0, colon));
    text.remove_prefix(colon + 1);
  }
  parts.push_back(text);
  return parts;
}

std::optional<int> parse_part(std::string_view part, std::string_view whole) {
  if (part.empty()) return std::nullopt;
  const auto value = number_in<int>(part);
  if (!value || *value < 0) throw Error(ExitCode::usage, "--frames: {}, got {}", kExpected, whole);
  return value;
}

}  // namespace

std::string FrameRange::text() const {
  return step == 1 ? fmt::format("{}:{}", begin, end) : fmt::format("{}:{}:{}", begin, end, step);
}

std::string frames_text(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t first = 0, next = 0; first < frames.size(); first = next) {
    for (next = first + 1; next < frames.size() && frames[next] == frames[next - 1] + 1;) ++next;
    if (first > 0) text += ", ";
    text += next == first + 1 ? fmt::format("{}", frames[first])
                              : fmt::format("{}:{}", frames[first], frames[next - 1] + 1);
  }
  return text;
}

FrameSelection parse_frames(std::string_view text) {
  const std::vector<std::string_view> parts = split(text);
  if (parts.size() < 2 || parts.size() > 3) throw Error(ExitCode::usage, "--frames: {}, got {}", kExpected, text);
  FrameSelection selection;
  selection.begin = parse_part(parts[0], text);
  selection.end = parse_part(parts[1], text);
  if (parts.size() == 3) selection.step = parse_part(parts[2], text).value_or(1);
  constexpr int kMaxStep = 1'000'000'000;  // so that the sum of a frame number and a step fits into an int
  if (selection.step < 1 || selection.step > kMaxStep)
    throw Error(ExitCode::usage, "--frames: expected a step from 1 to {}, got {}", kMaxStep, text);
  if (selection.end && selection.begin.value_or(0) >= *selection.end) {
    throw Error(ExitCode::usage, "--frames: {} names no frame: the second number is not part of the range", text);
  }
  return selection;
}

FrameRange resolve_frames(const FrameSelection& selection, int frame_count) {
  const FrameRange range{selection.begin.value_or(0), selection.end.value_or(frame_count), selection.step};
  if (range.end > frame_count || range.begin >= range.end) {
    throw Error(ExitCode::usage, "--frames: expected a range within 0:{}, the frames of this scene, got {}",
                frame_count, range.text());
  }
  return range;
}

}  // namespace weft::cli
