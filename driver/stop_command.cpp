#include "driver/stop_command.hpp"

#include "core/error.hpp"
#include "driver/command_line.hpp"
#include "io/atomic_file.hpp"
#include "io/folder_lock.hpp"
#include "io/run_folder.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

std::string ask_to_stop(const std::filesystem::path& path) {
  const io::RunFolder folder(path);
  if (!folder.is_run_folder())
    throw InputError(fmt::format("{} is not a run folder; give the folder that thalweg run writes.", path.string()));
  std::error_code ignored;
  if (std::filesystem::exists(folder.summary(), ignored) && !io::FolderLock::is_held(path).value_or(false))
    return fmt::format("{} has ended; thalweg info {} tells how.", path.string(), shell_word(path.string()));
  io::write_text_atomically(folder.stop(), "");
  return fmt::format("If {} is running, it saves its state and ends within a step; --restart {} goes on from there.",
                     path.string(), shell_word(path.string()));
}

}  // namespace thalweg::driver
