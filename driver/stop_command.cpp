#include "driver/stop_command.hpp"

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/run_folder.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

std::string ask_to_stop(const std::filesystem::path& path) {
  const io::RunFolder folder(path);
  if (!folder.is_run_folder())
    throw InputError(fmt::format("{} is not a run folder; give the folder that thalweg run writes.", path.string()));
  io::write_text_atomically(folder.stop(), "");
  return fmt::format("If {} is running, it saves its state and ends within a step; --restart {} goes on from there.",
                     path.string(), path.string());
}

}  // namespace thalweg::driver
