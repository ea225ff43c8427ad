// The parsed command line.
#pragma once

#include "core/base/types.hpp"
#include "driver/cli/clump_command.hpp"
#include "driver/cost/performance_model.hpp"
#include "driver/plan/new_case.hpp"

#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

struct Command {
  enum class Kind { run, check, create, clump, defaults, info, stop } kind = Kind::run;
  std::string path;                   // CASE.yaml of run and check; run folder of stop, or checkpoint of info
  std::vector<std::string> runs;      // of info: with --csv any number, else only `path`
  std::string system;                 // of defaults, or section; empty: resolved
  std::vector<std::string> settings;  // "key.sub=VALUE" of --set, in order
  std::string out;                    // run folder; empty: "run" beside the case file
  std::string restart;                // run folder or checkpoint; empty: start anew
  std::optional<double> until;        // s, instead of the case's run.until
  double walltime = 0.0;              // s; 0: none
  std::optional<Index3> layout;       // ranks along x, y, z
  bool overwrite = false;
  bool resume = false;     // begin the run, or go on with it, by what `out` holds
  std::vector<int> ranks;  // of check: numbers of ranks to plan for
  Network network;         // the same: between them
  bool csv = false;        // of info
  bool json = false;       // of check and info
  bool schema = false;     // of defaults
  bool solve = false;      // of check
  Experiment experiment;   // of create
  ClumpOrder clump_order;
  std::string line;  // the command as given

  std::vector<std::string> all_settings() const;  // of --set, and the end of --until
};

struct CommandLine {
  std::optional<Command> command;  // none: print `text` and end with `exit_code`
  std::string text;                // help or version (exit code 0), or what is wrong in one sentence (exit code 2)
  int exit_code = 0;
};

CommandLine parse_command_line(int argc, const char* const* argv);

// "HH:MM:SS", "MM:SS" or "D-HH:MM:SS" in seconds. Throws InputError.
double parse_walltime(const std::string& text);

// "PX,PY,PZ" with PX PY PZ >= 1. Throws InputError.
Index3 parse_layout(const std::string& text);

}  // namespace thalweg::driver
