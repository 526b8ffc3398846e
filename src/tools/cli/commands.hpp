// One function per command. Each returns the exit code or throws Error.
#pragma once

#include "core/error.hpp"
#include "tools/cli/options.hpp"

namespace weft::cli {

/// Simulates a scene, and draws and writes its film at the same time. On SIGINT, SIGTERM, SIGHUP or a failure, the
/// command ends early and keeps the finished frames.
ExitCode run(const RunOptions& options);

/// Simulates into a frame cache.
ExitCode simulate(const SimulateOptions& options);

/// Draws and writes the frames of a frame cache.
ExitCode render(const RenderOptions& options);

/// Checks scenes. Mistakes go to standard error, valid scenes and plans to standard output.
ExitCode check(const CheckOptions& options);

/// Draws one still of each scene: the start if `options.start` is set, else the given frame, else
/// the frame with the highest saliency (film/render/saliency.hpp).
ExitCode thumbnail(const ThumbnailOptions& options);

/// Draws evenly spaced frames of a scene into one picture, with their numbers and times.
ExitCode sheet(const SheetOptions& options);

/// Joins the parts of a film to one video.
ExitCode join(const JoinOptions& options);

/// Runs one scene many times with different values. Returns ExitCode::interrupted after a stop request, else the exit
/// code of the first failed run in the order of the sweep; 0 if none failed.
ExitCode sweep(const SweepOptions& options);

/// Submits runs and sweeps to a Slurm cluster, reports their progress, or cancels them.
ExitCode farm(const FarmOptions& options);

/// Writes a template: a scene, or a folder of scenes for a repository.
ExitCode make_new(const NewOptions& options);

/// Names of the templates that make_new() accepts.
std::vector<std::string> template_names();

/// Draws a scene again whenever one of its files changes, until the command is interrupted or has made `options.times`
/// drawings.
ExitCode watch(const WatchOptions& options);

/// Prints processor, libraries, OpenGL and encoder of this machine, and tests drawing and encoding.
/// Returns the exit code of the first failed test; 0 if none failed.
ExitCode doctor(const DoctorOptions& options);

/// Measures stability, accuracy, speed or fabrics, and writes tables and plots. Without a scene,
/// `bench stability` returns exit code 1 if a simulation computes values that are not finite, or
/// ends with more energy than allowed without a warning in any frame.
ExitCode bench(const BenchOptions& options);

/// Prints the difference of each pair of a reference and a picture. Returns exit code 4 if a file cannot be read, else
/// 7 if a pair differs or a reference has no picture, else 8 if a picture has no reference.
ExitCode diff(const DiffOptions& options);

/// Replaces references by the given files, and writes the reason to the log.
ExitCode accept(const AcceptOptions& options);

/// Writes the review page: videos, pictures, plots and statistics of runs.
ExitCode review(const ReviewOptions& options);

/// Exports the frames of a frame cache to files for other programs.
ExitCode export_frames(const ExportOptions& options);

}  // namespace weft::cli
