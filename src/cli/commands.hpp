// What each command does. All return the exit code or throw Error.
#pragma once

#include "cli/options.hpp"
#include "core/error.hpp"

namespace weft::cli {

/// Simulates, draws and writes side by side; ends early but in order on SIGINT, SIGTERM or failure, keeping what is
/// finished.
ExitCode run(const RunOptions& options);

/// Simulates into a frame cache.
ExitCode simulate(const SimulateOptions& options);

/// Draws and writes what a frame cache holds.
ExitCode render(const RenderOptions& options);

/// Mistakes go to standard error, good scenes and plans to standard output.
ExitCode check(const CheckOptions& options);

/// One still: the frame that is asked for, or the one that tells most.
ExitCode thumbnail(const ThumbnailOptions& options);

/// Evenly spaced frames on one picture, with their numbers and times.
ExitCode sheet(const SheetOptions& options);

/// Puts the parts of a film together to one video.
ExitCode join(const JoinOptions& options);

/// Runs a scene with many values; ends with the exit code of the first run that failed.
ExitCode sweep(const SweepOptions& options);

/// Hands runs and sweeps to a Slurm cluster, tells how far they are, takes them back.
ExitCode farm(const FarmOptions& options);

/// Writes a first scene to go on from.
ExitCode make_new(const NewOptions& options);

/// What make_new() can take.
std::vector<std::string> template_names();

/// Draws a scene again whenever one of its files changes, until it is interrupted.
ExitCode watch(const WatchOptions& options);

/// Prints what this machine offers and tries it.
ExitCode doctor(const DoctorOptions& options);

/// Measures what this program can do and writes tables and plots; exit code 1 where a case ends in nonsense.
ExitCode bench(const BenchOptions& options);

/// Prints how each pair differs; exit code 4, 7 or 8 where one cannot be read, differs, or has no reference.
ExitCode diff(const DiffOptions& options);

/// Replaces references by the files named, after writing down why.
ExitCode accept(const AcceptOptions& options);

/// Writes the page for looking at runs.
ExitCode review(const ReviewOptions& options);

/// Writes what a frame cache holds as files for other programs.
ExitCode export_frames(const ExportOptions& options);

}  // namespace weft::cli
