// The scripts of a farm: one that does any task, wherever it is started, one that hands the tasks to Slurm, and a list
// of them for other schedulers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/frame_range.hpp"
#include "cli/options.hpp"
#include "cli/sweep_jobs.hpp"

namespace weft::cli {

/// What the scheduler is told to keep free for a task.
struct Needs {
  int memory = 0;                      ///< [MB]
  int simulate_minutes, draw_minutes;  ///< at most
};

struct FarmPlan {
  std::vector<SweepJob> jobs;          ///< all runs
  std::vector<FrameRange> frames;      ///< of each that are drawn
  std::vector<std::size_t> submitted;  ///< of jobs: those to do, ascending
  int part = 50;                       ///< frames of a drawing task
  std::string archive;                 ///< fingerprint of the program that tasks unpack; empty: they run this one
  Needs needs;

  int parts(std::size_t job) const { return (frames[job].count() + part - 1) / part; }
};

/// Of an archive, in the folder of the runs; without its ending: what a task has unpacked.
std::string program_tar(const std::string& archive);

/// `farm/task.sh`: with paths that hold on all machines that share the folder.
std::string task_script(const FarmOptions& options, const FarmPlan& plan);

/// `farm/submit.sh`: sbatch, with what waits for what; numbers and names of jobs go to `farm/jobs`.
std::string submit_script(const FarmOptions& options, const FarmPlan& plan);

/// `farm/tasks.tsv`: name, names of the tasks to wait for, command.
std::string task_list(const FarmOptions& options, const FarmPlan& plan);

}  // namespace weft::cli
