// The JSON lines of --log-json.
#pragma once

#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

namespace weft::cli {

/// One JSON object a line: `event`, then what belongs to it. Written straight under its final name, because each line
/// is whole in itself and is there to be followed. Safe from all threads.
class EventLog {
 public:
  /// `destination`: a file, made anew; "-" for standard output; empty for none. Throws Error(output_failed).
  explicit EventLog(std::string destination);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// A failing log does not stop a run of hours: it is remembered and told by check().
  void write(const char* event, nlohmann::ordered_json fields);

  /// Throws Error(output_failed) if any line was lost.
  void check();

 private:
  const std::string destination_;
  std::FILE* file_ = nullptr;
  std::mutex mutex_;
  int error_ = 0;  // errno of the first failure
};

}  // namespace weft::cli
