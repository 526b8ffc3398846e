// Starts the real program in its own process, as a shell does.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace weft::cli {

struct Outcome {
  int exit_code = -1;  ///< 128 + signal if a signal ended the process, as in shells
  std::string out, err;
};

/// WEFT_PROGRAM with `arguments`, started in `folder`, which must exist. Standard input is empty.
class Subprocess {
 public:
  enum class Start {
    program,  ///< WEFT_PROGRAM is executed
    fork,     ///< see run_weft()
  };

  /// `file_size_limit`: maximum size of each file [bytes], which simulates a full disk; 0 for no limit.
  Subprocess(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
             std::size_t file_size_limit = 0, Start start = Start::program);
  ~Subprocess();  ///< kills the process if it still runs
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  /// Waits until the output so far contains `text`; false if the program ended, or a minute passed, without it.
  bool wait_for_output(const std::string& text);
  void send(int signal) const;
  Outcome wait();

 private:
  bool read_some(int timeout_ms);  // false once both pipes have ended

  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;
  Outcome outcome_;
};

/// True if `text` contains `part`.
inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The words of both lists.
inline std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Options with which drawing takes little time.
inline const std::vector<std::string> kSmall{"--size", "64x36", "--quality", "draft", "--progress", "none"};

/// Runs one command. If the test has one thread, a fork of it calls the function that main() calls. This saves loading
/// the program and its libraries: 0.15 to 0.3 CPU s. Builds with sanitizers always execute WEFT_PROGRAM.
Outcome run_weft(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// Expects that a command has ended with this exit code, and that its messages contain `words`.
inline void expect_exit(const Outcome& outcome, int exit_code, const std::string& words = "") {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, words)) << "expected: " << words << "\ngot: " << outcome.err;
}

}  // namespace weft::cli
