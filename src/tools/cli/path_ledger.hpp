// Registers all paths that a command reads and writes, so that the command never overwrites its inputs, and overwrites
// other files only if the user allows it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace weft::cli {

/// All paths of one command. The command registers them before any work, inputs first. Functions that register an
/// output throw Error(usage) if this output is an input or another output, lies inside one, or contains one. They
/// resolve symbolic links and `..`, and recognise hard links to inputs.
class PathLedger {
 public:
  /// Registers an input file. `what` names it in messages, such as "the scene".
  void reads(const std::filesystem::path& file, const std::string& what);
  /// Registers a folder that the command reads as a whole, such as a frame cache. No output may be inside.
  void reads_folder(const std::filesystem::path& folder, const std::string& what);
  /// Registers a folder from which the command reads single files. Outputs may be inside.
  void searches(const std::filesystem::path& folder, const std::string& what);

  /// Registers output files. `place` is the folder or pattern that the user has given for them.
  void writes(const std::string& option, const std::filesystem::path& place,
              const std::vector<std::filesystem::path>& files);
  void writes(const std::string& option, const std::filesystem::path& file) { writes(option, file, {file}); }
  /// Registers an output file. An existing file with the same content may be overwritten.
  void writes_content(const std::string& option, const std::filesystem::path& file, const std::string& content);
  /// Registers a folder that the command uses exclusively. The code that creates the folder checks what the folder
  /// contains.
  void register_output_folder(const std::string& option, const std::filesystem::path& folder);

  /// Throws Error(output_failed) if a folder has the name of an output file, or if an output file
  /// exists and `overwrite` is false. An existing file is allowed if it has the content given to
  /// writes_content(), or if its output is in `own` and `is_own` returns true for the file. `own`:
  /// outputs() of the run that is resumed. If `overwrite` is false, the command also does not
  /// replace files that other processes create after this call. Throws Error(usage) if a name is too long.
  void check_absent(bool overwrite, const std::set<std::string>& own = {},
                    const std::function<bool(const std::filesystem::path&)>& is_own = {}) const;
  /// Throws Error(output_failed) if the first file of an output cannot be written.
  void check_writable() const;
  /// Option and place of each output, without the folders of register_output_folder().
  std::set<std::string> outputs() const;

 private:
  struct Place {
    std::string what;       // text for messages: "the scene, which is read" or "what -o writes"
    bool searched = false;  // whether outputs may be inside
  };
  struct Output {
    std::string name;  // option and place
    std::vector<std::filesystem::path> files;
    std::string content;  // an existing file with this content may be overwritten; empty: no existing file may
  };
  using FileId = std::pair<unsigned long, unsigned long>;  // device and inode

  std::string resolved(const std::filesystem::path& path);
  void add_input(const std::filesystem::path& path, const std::string& what, bool searched);
  void add_output(const std::string& option, const std::filesystem::path& path);

  std::map<std::string, Place> places_;  // by resolved path
  std::map<FileId, std::string> inputs_;
  std::map<std::string, std::string> folders_;  // cache of resolved folders, since thousands of files share few folders
  std::vector<Output> outputs_;
};

}  // namespace weft::cli
