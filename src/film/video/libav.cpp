#include "film/video/libav.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <deque>
#include <mutex>

#include "core/error.hpp"

namespace weft::video {
namespace {

// Size of the log buffer [lines].
constexpr std::size_t kMaxLogLines = 4;

std::mutex g_log_mutex;  // encoder threads log too
std::deque<std::string> g_log_lines;

// Callback of libav: stores a warning or error in the log buffer, unless the buffer already contains its text.
void append_to_log(void* source, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_WARNING) return;
  std::array<char, 512> text{};
  int print_prefix = 0;  // without prefix, which would contain a memory address
  av_log_format_line2(source, level, format, arguments, text.data(), static_cast<int>(text.size()), &print_prefix);
  std::string line(text.data());
  while (!line.empty() && line.back() == '\n') line.pop_back();

  const std::lock_guard lock(g_log_mutex);
  if (line.empty() || std::find(g_log_lines.begin(), g_log_lines.end(), line) != g_log_lines.end()) return;
  g_log_lines.push_back(std::move(line));
  if (g_log_lines.size() > kMaxLogLines) g_log_lines.pop_front();
}

std::string take_log() {
  const std::lock_guard lock(g_log_mutex);
  std::string text;
  for (const std::string& line : g_log_lines) text += "; " + line;
  g_log_lines.clear();
  return text;
}

}  // namespace

void OutputDeleter::operator()(AVFormatContext* output) const {
  avio_closep(&output->pb);
  avformat_free_context(output);
}

void collect_log() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_callback(append_to_log); });
  take_log();
}

void fail(const std::filesystem::path& file, std::string_view step, std::string_view reason) {
  throw Error(ExitCode::output_failed, "{}: cannot {}: {}{}", file.string(), step, reason, take_log());
}

int check(int code, const std::filesystem::path& file, std::string_view step) {
  if (code >= 0) return code;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(code, reason.data(), reason.size());
  fail(file, step, reason.data());
}

}  // namespace weft::video
