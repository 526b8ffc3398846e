// No file is ever lost: the one place that knows what a command reads and writes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace weft::cli {

/// All paths of one command, told before any work is done; those that are read first. Through links, hard links and
/// `..`, no output may be an input, another output, or inside of a file or folder that is either: Error(usage).
class PathLedger {
 public:
  /// A file; `what` it is, for messages: "the scene".
  void reads(const std::filesystem::path& file, const std::string& what);
  /// A folder that is read as a whole, such as a frame cache: nothing else may be put there.
  void reads_folder(const std::filesystem::path& folder, const std::string& what);
  /// A folder of which files are taken: others may be put there.
  void searches(const std::filesystem::path& folder, const std::string& what);

  /// Files that are written; `place` stands for all of them: the folder or pattern that the user has given.
  void writes(const std::string& option, const std::filesystem::path& place,
              const std::vector<std::filesystem::path>& files);
  void writes(const std::string& option, const std::filesystem::path& file) { writes(option, file, {file}); }
  /// A file that loses nothing where it holds the same already.
  void writes_content(const std::string& option, const std::filesystem::path& file, const std::string& content);
  /// A folder that the command has for itself. Who makes it sees to what is there.
  void fills(const std::string& option, const std::filesystem::path& folder);

  /// Throws Error(output_failed) where one of the files is there already, or a folder of its name. Those that are not
  /// there are kept if somebody makes them meanwhile. `own`: outputs() of an interrupted run that is gone on with; of
  /// those are replaced which `is_own`.
  void check_absent(bool overwrite, const std::set<std::string>& own = {},
                    const std::function<bool(const std::filesystem::path&)>& is_own = {}) const;
  /// Throws Error(output_failed) where the first file of an output cannot be written.
  void check_writable() const;
  /// What the outputs are: option and place.
  std::set<std::string> outputs() const;

 private:
  struct Place {
    std::string what;       // "the scene, which is read", "what -o writes"
    bool searched = false;  // may hold outputs
  };
  struct Output {
    std::string name;  // option and place
    std::vector<std::filesystem::path> files;
    std::string content;  // that it may have already
  };
  using FileId = std::pair<unsigned long, unsigned long>;  // device and inode

  std::string resolved(const std::filesystem::path& path);
  void add_input(const std::filesystem::path& path, const std::string& what, bool searched);
  void add_output(const std::string& option, const std::filesystem::path& path);

  std::map<std::string, Place> places_;  // by resolved path
  std::map<FileId, std::string> inputs_;
  std::map<std::string, std::string> folders_;  // resolved before: thousands of files share few
  std::vector<Output> outputs_;
};

}  // namespace weft::cli
