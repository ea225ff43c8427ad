#include "driver/cli/run_paths.hpp"

#include "core/parallel/on_first_rank.hpp"

#include <string>

namespace thalweg::driver {
namespace {

namespace fs = std::filesystem;

constexpr char path_end = '\0';  // in no path

// The run folder a checkpoint lies in; empty if it lies anywhere else.
fs::path run_folder_of(const fs::path& checkpoint) {
  const fs::path checkpoints = fs::absolute(checkpoint).lexically_normal().parent_path();
  const io::RunFolder folder(checkpoints.parent_path());
  return folder.is_run_folder() && folder.checkpoints() == checkpoints ? folder.path() : fs::path();
}

RunPaths found_by(const Command& command) {
  std::vector<fs::path> checkpoints;
  fs::path origin;
  if (!command.restart.empty()) {
    checkpoints = io::checkpoints_at(command.restart);
    origin = run_folder_of(checkpoints.front());
  }
  const fs::path out = command.out.empty() && !origin.empty() ? origin : folder_without_restart(command);
  std::error_code ignored;
  const bool same = !origin.empty() && fs::equivalent(out, origin, ignored);
  return {checkpoints, origin, io::RunFolder(out), same};
}

std::string as_text(const RunPaths& paths) {
  std::string text(1, paths.same_folder ? 's' : 'o');
  text += paths.folder.path().string() + path_end + paths.origin.string() + path_end;
  for (const fs::path& checkpoint : paths.checkpoints) text += checkpoint.string() + path_end;
  return text;
}

RunPaths of_text(const std::string& text) {
  std::vector<fs::path> paths;
  for (std::size_t start = 1; start < text.size();) {
    const std::size_t end = text.find(path_end, start);
    paths.emplace_back(text.substr(start, end - start));
    start = end + 1;
  }
  return {{paths.begin() + 2, paths.end()}, paths[1], io::RunFolder(paths[0]), text.front() == 's'};
}

}  // namespace

fs::path folder_without_restart(const Command& command) {
  return command.out.empty() ? fs::path(command.path).parent_path() / "run" : fs::path(command.out);
}

RunPaths paths_of(const Command& command, MPI_Comm communicator) {
  return of_text(told_by_first_rank(communicator, [&] { return as_text(found_by(command)); }));
}

}  // namespace thalweg::driver
