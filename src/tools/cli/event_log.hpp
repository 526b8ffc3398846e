// The JSON lines of --log-json.
#pragma once

#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

namespace weft::cli {

/// Writes one JSON object per line: the name of the event, then its fields. The file has its final name from the start,
/// so that other programs can read it during the run. Thread-safe.
class EventLog {
 public:
  /// `destination`: a file, which is replaced; "-" for standard output; empty for none. Throws Error(output_failed).
  explicit EventLog(std::string destination);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// Does not throw, since a failing log must not stop a long run. check() reports the failure.
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
