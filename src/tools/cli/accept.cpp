#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "core/log.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/compare/acceptance.hpp"
#include "tools/compare/files.hpp"
#include "tools/compare/references.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

std::string user_name() {
  const char* name = std::getenv("USER");
  if (name && *name) return name;
  const passwd* entry = ::getpwuid(::geteuid());
  return entry ? entry->pw_name : fmt::format("user {}", ::geteuid());
}

bool is_blank(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) != 0; });
}

// Reports references without a picture in `test`. They stay, since the command never removes a reference.
void report_unmatched_references(const fs::path& references, const fs::path& test,
                                 const std::vector<std::string>& names) {
  if (!fs::is_directory(references)) return;
  for (const std::string& name : compare::reference_names(references, compare::machine_class_of(test, names)))
    if (!std::binary_search(names.begin(), names.end(), name))
      log::info(fmt::format("note: {} has no counterpart in {}; it stays", name, test.string()));
}

}  // namespace

ExitCode accept(const AcceptOptions& options) {
  if (is_blank(options.reason)) {
    throw Error(ExitCode::usage, "--reason: expected a text that says why the picture changed");
  }
  const bool is_file = compare::is_comparable(options.reference) && !std::filesystem::is_directory(options.reference);
  if (is_file && options.tests.size() > 1) {
    throw Error(ExitCode::usage, "{} files cannot all become {}: name the folder of references instead",
                options.tests.size(), options.reference.string());
  }
  // Checks all files before it changes the first reference.
  std::vector<compare::Acceptance> plans;
  const auto add = [&](const fs::path& test, const std::string& name) {
    plans.push_back(compare::Acceptance::plan(options.reference, test, name));
    plans.back().reason = options.reason;
    plans.back().user = user_name();
  };
  for (const fs::path& test : options.tests) {
    if (!fs::is_directory(test)) {
      add(test, test.filename());
      continue;
    }
    if (is_file)
      throw Error(ExitCode::usage, "{}: a folder cannot become {}: name the folder of references instead",
                  test.string(), options.reference.string());
    const std::vector<std::string> names = compare::comparable_names(test);
    if (names.empty()) throw Error(ExitCode::asset_unreadable, "{}: holds no pictures or videos", test.string());
    for (const std::string& name : names) add(test / name, name);
    report_unmatched_references(options.reference, test, names);
  }
  PathLedger paths;
  for (const compare::Acceptance& plan : plans) paths.reads(plan.test, "a picture to accept");
  for (const compare::Acceptance& plan : plans) paths.writes("REFERENCE", plan.reference);
  if (!plans.empty()) paths.writes("the log", plans.front().log);
  paths.check_absent(true);  // may overwrite: the user names the references in order to replace them
  for (const compare::Acceptance& plan : plans) {
    const bool changed = plan.carry_out();
    log::info(log::without_controls(
        fmt::format("{}: {}", plan.reference.string(),
                    changed ? fmt::format("now as {}", plan.test.string()) : "is the same already"),
        ""));
  }
  return ExitCode::ok;
}

}  // namespace weft::cli
