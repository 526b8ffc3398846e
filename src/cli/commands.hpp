// One function per command. Each returns the exit code or throws Error.
#pragma once

#include "cli/options.hpp"
#include "core/error.hpp"

namespace weft::cli {

/// Simulates, draws and writes concurrently. On SIGINT, SIGTERM or a failure it ends early and keeps what is finished.
ExitCode run(const RunOptions& options);

/// Simulates into a frame cache.
ExitCode simulate(const SimulateOptions& options);

/// Draws and writes the frames of a frame cache.
ExitCode render(const RenderOptions& options);

/// Checks scenes. Mistakes go to standard error, valid scenes and plans to standard output.
ExitCode check(const CheckOptions& options);

/// Draws one still: the requested frame, or the most informative one.
ExitCode thumbnail(const ThumbnailOptions& options);

/// Draws evenly spaced frames on one picture, with their numbers and times.
ExitCode sheet(const SheetOptions& options);

/// Joins the parts of a film to one video.
ExitCode join(const JoinOptions& options);

/// Runs a scene with many values; returns the exit code of the first run that failed.
ExitCode sweep(const SweepOptions& options);

/// Submits runs and sweeps to a Slurm cluster, reports their progress, cancels them.
ExitCode farm(const FarmOptions& options);

/// Writes a template scene.
ExitCode make_new(const NewOptions& options);

/// Names of the templates that make_new() accepts.
std::vector<std::string> template_names();

/// Draws a scene again whenever one of its files changes, until it is interrupted.
ExitCode watch(const WatchOptions& options);

/// Prints what this machine offers and tests it.
ExitCode doctor(const DoctorOptions& options);

/// Measures the program and writes tables and plots. Returns exit code 1 if a stability case is wrong (unbounded energy
/// or not finite).
ExitCode bench(const BenchOptions& options);

/// Prints the difference of each pair; exit code 4, 7 or 8 if one cannot be read, differs, or has no reference.
ExitCode diff(const DiffOptions& options);

/// Replaces references by the named files, after logging the reason.
ExitCode accept(const AcceptOptions& options);

/// Writes the review page.
ExitCode review(const ReviewOptions& options);

/// Exports the frames of a frame cache to files for other programs.
ExitCode export_frames(const ExportOptions& options);

}  // namespace weft::cli
