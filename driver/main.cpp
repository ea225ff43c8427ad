// The program: one command line, the same on every rank. Only `run` starts MPI.
#include "core/base/error.hpp"
#include "core/base/error_message.hpp"
#include "core/parallel/failure_barrier.hpp"
#include "core/parallel/mpi_session.hpp"
#include "driver/cli/command_line.hpp"
#include "driver/cli/info_report.hpp"
#include "driver/cli/info_table.hpp"
#include "driver/cli/python_command.hpp"
#include "driver/cli/run_command.hpp"
#include "driver/cli/stop_command.hpp"
#include "driver/cost/core_speed.hpp"
#include "driver/cost/machine.hpp"
#include "driver/cost/memory.hpp"
#include "driver/cost/scaling_table.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/plan/check_report.hpp"
#include "driver/plan/solve.hpp"
#include "loop/stop_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace thalweg;
using namespace thalweg::driver;

enum ExitCode { done = 0, run_failed = 1, bad_input = 2, interrupted = 3, asked_to_stop = 4 };

struct Failure {
  ExitCode code;
  std::string message;
};

// Message and exit code of the exception being handled.
Failure failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return {bad_input, error_message(error)};
  } catch (const std::exception& error) {
    return {run_failed, error_message(error)};
  }
}

void complain(const std::string& message) { std::fprintf(stderr, "thalweg: %s\n", message.c_str()); }

// Ends the program after an error: in good order if it met every rank, else by force, since the others are waiting.
// The error is then the only thing said: mpirun sends SIGTERM to the last ranks to leave once the first has failed.
int end_with(const Failure& failed, FailureBarrier& failures, bool prints) {
  const bool together = failures.all_ranks_failed(seconds_to_wait_for_others);
  if (prints || !together) complain(failed.message);
  if (!together) MPI_Abort(MPI_COMM_WORLD, failed.code);
  loop::end_on_stop_signals(failed.code, false);
  return failed.code;
}

// True for a single process and for the first of a launcher, judged by the variables that launchers set. Used by
// commands that run without MPI, which may not start on login nodes.
bool first_of_its_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (const char* rank = std::getenv(name)) return std::strcmp(rank, "0") == 0;
  return true;
}

ExitCode exit_code_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::finished:
      return done;
    case Outcome::interrupted:
      return interrupted;
    default:
      return asked_to_stop;
  }
}

// Open MPI's mpirun takes every exit code but 0 for a failure, and says so after the last line of the run.
void announce(ExitCode code) {
  if (!std::getenv("OMPI_COMM_WORLD_SIZE")) return;
  std::printf("exit code %d: the run was stopped in good order; what mpirun says of this code is no error\n", code);
  std::fflush(stdout);
}

int run(const Command& command, int argc, char** argv, loop::WallClock::time_point started) {
  loop::end_on_stop_signals(interrupted, first_of_its_launcher());
  MpiSession session(argc, argv);
  const bool prints = rank_of(MPI_COMM_WORLD) == 0;
  FailureBarrier failures(MPI_COMM_WORLD);
  loop::Log log(prints);
  try {
    const ExitCode code = exit_code_of(run_case(command, MPI_COMM_WORLD, started, failures, log));
    if (prints && code != done) announce(code);
    return code;
  } catch (...) {
    return end_with(failure(), failures, prints);
  }
}

std::string joined(const std::vector<std::string>& lines) { return fmt::format("{}\n", fmt::join(lines, "\n")); }

// bytes/s, of one core's memory, which bounds nothing but a lattice.
double bandwidth_for(const Case& c) { return has_fluid(c) ? measure_bandwidth() : 0.0; }

std::vector<std::string> check_of(const Command& command, const Case& c) {
  return about_case(command.path, [&] { return check_report(c, bandwidth_for(c)); });
}

Case case_of(const Command& command) { return read_case(command.path, command.all_settings()); }

// The report, and the refusal of what this machine has not the memory for: it is said last, with the report to go by.
void check(const Command& command) {
  const Case c = case_of(command);
  if (command.solve) {
    std::fputs(joined(solution_report(c, command.path, command.all_settings())).c_str(), stdout);
    return;
  }
  const auto json = [&] { return about_case(command.path, [&] { return check_json(c, bandwidth_for(c)); }); };
  std::fputs((command.json ? json() : joined(check_of(command, c))).c_str(), stdout);
  std::fflush(stdout);
  about_case(command.path, [&] { refuse_without_memory(c); });
}

// check --ranks: every rank times a sample of the case, as many ranks at a time as a node has cores.
int plan(const Command& command, int argc, char** argv) {
  MpiSession session(argc, argv);
  const bool prints = rank_of(MPI_COMM_WORLD) == 0;
  FailureBarrier failures(MPI_COMM_WORLD);
  try {
    const Case c = case_of(command);
    const std::vector<std::string> report = check_of(command, c);
    if (c.system == SystemKind::continuum) throw InputError("--ranks: every rank has the whole column; remove it.");
    const CoreSpeed speed = measure_core_speed(c, MPI_COMM_WORLD);
    const std::vector<std::string> table = scaling_table(c, command.ranks, speed, command.network);
    if (prints) std::fputs((joined(report) + joined(table)).c_str(), stdout);
    return done;
  } catch (...) {
    return end_with(failure(), failures, prints);
  }
}

// Output of a command other than run.
std::string answer(const Command& command) {
  switch (command.kind) {
    case Command::Kind::check:
      check(command);
      return {};
    case Command::Kind::create:
      return joined(write_new_case(command.experiment, command.path, measure_bandwidth()));
    case Command::Kind::clump:
      std::fputs(joined(clump_report(command.clump_order)).c_str(), stdout);
      std::fflush(stdout);
      draw_clump(command.clump_order);
      return {};
    case Command::Kind::info:
      if (command.json) return info_json(command.path);
      return joined(command.csv ? info_table(command.runs) : info_report(command.path));
    case Command::Kind::stop:
      return joined({ask_to_stop(command.path)});
    default:
      if (command.schema) return case_schema();
      return defaults_yaml(command.system.empty() ? "resolved" : command.system);
  }
}

// Every command but run, and complaints about the command line. Of several ranks only the first does anything.
int run_without_mpi(const CommandLine& line) {
  if (!first_of_its_launcher()) return line.exit_code;
  flush_denormals_to_zero();
  try {
    if (line.exit_code != done) throw InputError(line.text);
    std::fputs((line.command ? answer(*line.command) : line.text).c_str(), stdout);
    return done;
  } catch (...) {
    const Failure failed = failure();
    complain(failed.message);
    return failed.code;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const loop::WallClock::time_point started = loop::WallClock::now();
  if (is_python_command(argc, argv)) return run_python_command(argc, argv);
  const CommandLine line = parse_command_line(argc, argv);
  if (line.command && line.command->kind == Command::Kind::run) return run(*line.command, argc, argv, started);
  if (line.command && line.command->kind == Command::Kind::check && !line.command->ranks.empty())
    return plan(*line.command, argc, argv);
  return run_without_mpi(line);
}
