#include "tools/cli/event_log.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/temporary_file.hpp"

namespace weft::cli {

using Json = nlohmann::ordered_json;

EventLog::EventLog(std::string destination) : destination_(std::move(destination)) {
  if (destination_.empty()) return;
  if (destination_ == "-") {
    file_ = stdout;
    return;
  }
  check_writable(destination_);  // also creates the folder
  // Removes the file instead of truncating it, so that hard links to it keep their content.
  if (may_replace(destination_)) std::remove(destination_.c_str());
  file_ = std::fopen(destination_.c_str(), "wbxe");
  if (file_ == nullptr) {
    throw Error(ExitCode::output_failed, "{}: cannot be written: {}", destination_, std::strerror(errno));
  }
}

EventLog::~EventLog() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
}

void EventLog::write(const char* event, Json fields) {
  if (file_ == nullptr) return;
  Json line{{"event", event}};
  line.update(fields);
  // Texts such as file names may not be UTF-8; json_text() replaces bytes that JSON cannot contain.
  const std::string text = json_text(line) + "\n";
  const std::lock_guard lock(mutex_);
  if (error_ != 0) return;
  const bool good = std::fwrite(text.data(), 1, text.size(), file_) == text.size() && std::fflush(file_) == 0;
  if (!good) error_ = errno;
}

void EventLog::check() {
  const std::lock_guard lock(mutex_);
  if (error_ == 0) return;
  const std::string name = destination_ == "-" ? "standard output" : destination_;
  throw Error(ExitCode::output_failed, "{}: the log is not complete: {}", name, std::strerror(error_));
}

}  // namespace weft::cli
