// The commands for CLI11, and the values that CLI11 sets while it parses the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/cli/options.hpp"

namespace weft::cli {

/// Adds a required argument without a placeholder.
template <class Value>
void add_argument(CLI::App& command, const char* name, Value& value, const char* description) {
  command.add_option(name, value, description)->required()->type_name("");
}

struct Parser {
  CLI::App app{"Weft: cloth scenes to video, on any machine, without a window.", "weft"};
  RunOptions run;
  SimulateOptions simulate;
  RenderOptions render;
  CheckOptions check;
  ThumbnailOptions thumbnail;
  SheetOptions sheet;
  JoinOptions join;
  SweepOptions sweep;
  FarmOptions farm;
  NewOptions new_scene;
  WatchOptions watch;
  std::string shell;  // argument of weft completion
  SchemaOptions schema;
  DoctorOptions doctor;
  BenchOptions bench;
  std::vector<BenchOption> bench_options;  // options on the command line that only some kinds of weft bench accept
  DiffOptions diff;
  AcceptOptions accept;
  ReviewOptions review;
  ExportOptions export_frames;

  Parser();

  void add_run();
  void add_simulate();
  void add_render();
  void add_check();
  void add_thumbnail();
  void add_sheet();
  void add_join();
  void add_sweep();
  void add_farm();
  void add_new();
  void add_watch();
  void add_completion();
  void add_schema();
  void add_doctor();
  void add_bench();
  void add_diff();
  void add_accept();
  void add_review();
  void add_export();

  std::vector<std::string> command_names() const;
  /// The command that was parsed; null before parsing.
  CLI::App* selected() const;
};

}  // namespace weft::cli
