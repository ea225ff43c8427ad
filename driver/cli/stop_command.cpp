#include "driver/cli/stop_command.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "driver/cli/info_report.hpp"
#include "io/files/atomic_file.hpp"
#include "io/folder/folder_lock.hpp"
#include "io/folder/run_folder.hpp"
#include "loop/time_loop.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <optional>

namespace thalweg::driver {
namespace {

// True if the last run in the folder has ended and no job will continue it.
bool has_ended_for_good(const io::RunFolder& folder) {
  const YAML::Node summary = whole_summary_in(folder);
  return summary.IsMap() &&
         (summary["finished"].as<bool>(false) || summary["reason"].as<std::string>("") == loop::stopped_on_request);
}

}  // namespace

std::string ask_to_stop(const std::filesystem::path& path) {
  const io::RunFolder folder(path);
  if (!folder.is_run_folder())
    throw InputError(fmt::format("{} is not a run folder; give the folder that thalweg run writes.", path.string()));
  const std::string name = path.string(), word = shell_word(name);
  const std::optional<bool> runs = io::FolderLock::is_held(path);
  if (!runs.value_or(false) && has_ended_for_good(folder))
    return fmt::format("{} has ended; see thalweg info {}.", name, word);
  io::write_text_atomically(folder.stop(), "");
  if (runs && !*runs)
    return fmt::format(
        "{} is not running now. A queued job that would resume it (thalweg run --resume) will end at once "
        "with exit code 4; to cancel this: rm {}",
        name, shell_word(folder.stop().string()));
  return fmt::format("{} its state and ends within a step; to continue, add --restart {} to the command of the run.",
                     runs ? name + " saves" : fmt::format("If {} is running, it saves", name), word);
}

}  // namespace thalweg::driver
