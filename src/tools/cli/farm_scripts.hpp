// Files with which `weft farm` distributes the runs of a sweep to machines: a script that performs the task given by
// its arguments, a script that submits all tasks to Slurm, and a list of the tasks for other schedulers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/cli/options.hpp"
#include "tools/cli/sweep_jobs.hpp"

namespace weft::cli {

/// Maximum number of tasks in a job array of Slurm: the default MaxArraySize minus one.
inline constexpr int kMaxArrayTasks = 1000;

/// Resources that a task requests from the scheduler.
struct Needs {
  int memory = 0;                      ///< [MB]
  int simulate_minutes, draw_minutes;  ///< time limits [min]
};

/// What the scripts contain. A job is one run. Tasks simulate a job, draw parts of its frames, and
/// join the parts.
struct FarmPlan {
  std::vector<SweepJob> jobs;          ///< all runs of the sweep
  std::vector<std::size_t> submitted;  ///< indices of the jobs that are not done yet, ascending; none: only the report
  int part = 1;                        ///< number of frames per drawing task
  std::string archive;  ///< fingerprint of the program archive that tasks unpack; empty: tasks run this program
  Needs needs;

  int parts(std::size_t job) const { return (jobs[job].drawn.count() + part - 1) / part; }
};

/// Path of the program archive with this fingerprint, relative to the folder of the runs. The same path without the
/// extension is the folder into which tasks unpack the archive.
std::string program_tar(const std::string& archive);

/// Text of `farm/task.sh`. The script uses absolute paths, so the folder of the runs and the scene
/// must have the same paths on all machines.
std::string task_script(const FarmOptions& options, const FarmPlan& plan);

/// Text of `farm/submit.sh`, which calls sbatch, and writes numbers and names of the Slurm jobs to `farm/jobs`.
std::string submit_script(const FarmOptions& options, const FarmPlan& plan);

/// Text of `farm/tasks.tsv`. Columns: name, names of the tasks to wait for, command.
std::string task_list(const FarmOptions& options, const FarmPlan& plan);

}  // namespace weft::cli
