#include "tools/review/review.hpp"

#include <fmt/format.h>

#include "core/log.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/signals.hpp"

namespace weft::cli {

ExitCode review(const ReviewOptions& options) {
  const StopSignals signals;
  review::Request request;
  request.folders = options.folders;
  request.reference = options.reference;
  request.output = options.output.empty() ? "output/review" : options.output;
  request.overwrite = options.overwrite;
  PathLedger paths;
  for (const std::filesystem::path& folder : options.folders) paths.searches(folder, "a folder of runs");
  if (!options.reference.empty()) paths.searches(options.reference, "the folder of references");
  paths.register_output_folder("-o", request.output);
  request.stop = [&signals] { return signals.requested().load(); };
  const review::Outcome outcome = review::write_review(request);
  std::string line = fmt::format("{}: {} run{}", outcome.page.string(), outcome.runs, outcome.runs == 1 ? "" : "s");
  if (outcome.incomplete > 0)
    line += fmt::format(", {} with something missing, which the page names", outcome.incomplete);
  if (outcome.approved > 0) line += fmt::format(", {} approved", outcome.approved);
  if (outcome.needing_work > 0) line += fmt::format(", {} to be worked on", outcome.needing_work);
  if (outcome.differing > 0) line += fmt::format(", {} differing from the reference", outcome.differing);
  log::info(line);
  return ExitCode::ok;
}

}  // namespace weft::cli
