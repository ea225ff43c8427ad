// The program: one command line, the same on every rank.
#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "driver/analyze_command.hpp"
#include "driver/case_reader.hpp"
#include "driver/check_report.hpp"
#include "driver/collective_failure.hpp"
#include "driver/command_line.hpp"
#include "driver/info_report.hpp"
#include "driver/machine.hpp"
#include "driver/on_first_rank.hpp"
#include "driver/run_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

using namespace thalweg;
using namespace thalweg::driver;

enum ExitCode { done = 0, run_failed = 1, bad_input = 2 };

void execute(const Command& command, WallClock::time_point started, FailureCouncil& council, Log& log) {
  const MPI_Comm world = MPI_COMM_WORLD;
  if (command.kind == Command::Kind::run) {
    run_case(command, world, started, council, log);
    return;
  }
  on_first_rank(world, [&] {
    const std::vector<std::string> lines =
        command.kind == Command::Kind::check
            ? check_report(read_case(command.path, command.settings), measure_bandwidth(MPI_COMM_SELF))
            : info_report(command.path);
    for (const std::string& line : lines) log.line(line);
  });
}

// Ends the program after an error: in good order if it met every rank, else by force, since the others are waiting.
int end_with(ExitCode code, const std::string& message, FailureCouncil& council, bool speaking) {
  const bool together = council.everybody_failed(seconds_to_wait_for_others);
  if (speaking || !together) std::fprintf(stderr, "thalweg: %s\n", message.c_str());
  if (!together) MPI_Abort(MPI_COMM_WORLD, code);
  return code;
}

// Whether this is the only process or the first that a launcher has started, by the variables that launchers set. For
// what is done without MPI, which may not start on login nodes.
bool first_of_its_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (const char* rank = std::getenv(name)) return std::strcmp(rank, "0") == 0;
  return true;
}

// Help, the defaults, and complaints about the command line.
int answer_without_mpi(CommandLine line) {
  if (line.command) {
    try {
      line.text = defaults_yaml(line.command->system.empty() ? "resolved" : line.command->system);
    } catch (const InputError& error) {
      line = {.command = {}, .text = error.what(), .exit_code = bad_input};
    }
  }
  if (first_of_its_launcher()) {
    if (line.exit_code == done)
      std::fputs(line.text.c_str(), stdout);
    else
      std::fprintf(stderr, "thalweg: %s\n", line.text.c_str());
  }
  return line.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  const WallClock::time_point started = WallClock::now();
  if (is_analyze(argc, argv)) return analyze(argc, argv);
  const CommandLine line = parse_command_line(argc, argv);
  if (!line.command || line.command->kind == Command::Kind::defaults) return answer_without_mpi(line);
  MpiSession session(argc, argv);
  const bool speaking = rank_of(MPI_COMM_WORLD) == 0;
  FailureCouncil council(MPI_COMM_WORLD);
  Log log(speaking);
  try {
    execute(*line.command, started, council, log);
    return done;
  } catch (const InputError& error) {
    return end_with(bad_input, error.what(), council, speaking);
  } catch (const RunError& error) {
    return end_with(run_failed, error.what(), council, speaking);
  } catch (const std::bad_alloc&) {
    return end_with(run_failed, "The memory of this machine is not enough for the case.", council, speaking);
  } catch (const std::exception& error) {
    return end_with(run_failed, fmt::format("An error nobody expected: {}.", error.what()), council, speaking);
  }
}
