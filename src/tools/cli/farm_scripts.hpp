// The scripts of a farm: one that performs any of the tasks, on any machine, one that submits the tasks to Slurm, and a
// list of the tasks for other schedulers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/cli/options.hpp"
#include "tools/cli/sweep_jobs.hpp"

namespace weft::cli {

/// Resources that a task requests from the scheduler.
struct Needs {
  int memory = 0;                      ///< [MB]
  int simulate_minutes, draw_minutes;  ///< time limits [min]
};

struct FarmPlan {
  std::vector<SweepJob> jobs;          ///< all runs
  std::vector<std::size_t> submitted;  ///< indices of the jobs to do, ascending
  int part = 50;                       ///< number of frames per drawing task
  std::string archive;  ///< fingerprint of the program archive that tasks unpack; empty: tasks run this program
  Needs needs;

  int parts(std::size_t job) const { return (jobs[job].drawn.count() + part - 1) / part; }
};

/// Path of the program archive, relative to the folder of the runs. The same path without the extension is the folder
/// into which tasks unpack the archive.
std::string program_tar(const std::string& archive);

/// `farm/task.sh`; its paths are valid on all machines that share the folder.
std::string task_script(const FarmOptions& options, const FarmPlan& plan);

/// `farm/submit.sh`: calls sbatch with dependencies; writes numbers and names of jobs to `farm/jobs`.
std::string submit_script(const FarmOptions& options, const FarmPlan& plan);

/// `farm/tasks.tsv`: name, names of the tasks to wait for, command.
std::string task_list(const FarmOptions& options, const FarmPlan& plan);

}  // namespace weft::cli
