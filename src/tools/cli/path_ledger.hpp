// Prevents the loss of files: registers everything that a command reads and writes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace weft::cli {

/// All paths of one command. The command registers them before any work, inputs first. Functions that register throw
/// Error(usage) if an output is an input or another output, or if it lies inside of either or contains one. Symbolic
/// links, hard links and `..` are followed.
class PathLedger {
 public:
  /// Registers an input file; `what` names it in messages: "the scene".
  void reads(const std::filesystem::path& file, const std::string& what);
  /// Registers a folder that is read as a whole, such as a frame cache: no output may be inside.
  void reads_folder(const std::filesystem::path& folder, const std::string& what);
  /// Registers a folder from which single files are read: outputs may be inside.
  void searches(const std::filesystem::path& folder, const std::string& what);

  /// Registers output files; `place` names them all in messages: the folder or pattern that the user has given.
  void writes(const std::string& option, const std::filesystem::path& place,
              const std::vector<std::filesystem::path>& files);
  void writes(const std::string& option, const std::filesystem::path& file) { writes(option, file, {file}); }
  /// Registers an output that may be overwritten if it already has this content.
  void writes_content(const std::string& option, const std::filesystem::path& file, const std::string& content);
  /// Registers a folder that the command uses exclusively. The code that creates the folder checks what it contains.
  void fills(const std::string& option, const std::filesystem::path& folder);

  /// Throws Error(output_failed) if an output file exists and `overwrite` is false, or if a folder has its name.
  /// Without `overwrite`, files that appear after this call are protected too. `own`: outputs() of an interrupted run
  /// that is resumed; existing files of these outputs may be replaced if `is_own` accepts them.
  void check_absent(bool overwrite, const std::set<std::string>& own = {},
                    const std::function<bool(const std::filesystem::path&)>& is_own = {}) const;
  /// Throws Error(output_failed) if the first file of an output cannot be written.
  void check_writable() const;
  /// Option and place of each output, without the folders of fills().
  std::set<std::string> outputs() const;

 private:
  struct Place {
    std::string what;       // for example "the scene, which is read" or "what -o writes"
    bool searched = false;  // may contain outputs
  };
  struct Output {
    std::string name;  // option and place
    std::vector<std::filesystem::path> files;
    std::string content;  // content that an existing file may have
  };
  using FileId = std::pair<unsigned long, unsigned long>;  // device and inode

  std::string resolved(const std::filesystem::path& path);
  void add_input(const std::filesystem::path& path, const std::string& what, bool searched);
  void add_output(const std::string& option, const std::filesystem::path& path);

  std::map<std::string, Place> places_;  // by resolved path
  std::map<FileId, std::string> inputs_;
  std::map<std::string, std::string> folders_;  // cache of resolved folders: thousands of files share few folders
  std::vector<Output> outputs_;
};

}  // namespace weft::cli
