#include "io/folder/run_folder.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "core/base/utf8.hpp"
#include "io/files/atomic_file.hpp"
#include "io/folder/folder_lock.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

namespace thalweg::io {
namespace fs = std::filesystem;
namespace {

// Folders of records, each with the name of its observer.
constexpr std::array record_folders{"probes", "tracks", "reach", "entrainment"};
// Other entries that a continued run changes in place: folders, and files that are not replaced as a whole.
constexpr std::array added_to{"grains",      "fluid",      "solids",    "fluid_parts", "grain_parts",
                              "checkpoints", "grains.pvd", "fluid.pvd", "solids.pvd",  "run.log"};
// Files that are replaced as a whole. Records were files in older versions.
constexpr std::array replaced{"series.csv",     "profiles.h5", "probes.h5",   "tracks.h5",
                              "entrainment.h5", "bed.h5",      "summary.json"};
// What thalweg analyze and thalweg report make of the run.
constexpr std::array made_of_the_run{"analysis", "report.html"};
constexpr const char* case_name = "case.yaml";
constexpr const char* latest_name = "latest";
constexpr const char* kept_case = "case_until_step_";

// The number in the name of a file; none: it is another file.
std::optional<std::int64_t> step_between(const std::string& name, std::string_view before, std::string_view after) {
  if (!name.starts_with(before) || !name.ends_with(after)) return std::nullopt;
  std::int64_t step = 0;
  const char* end = name.data() + name.size() - after.size();
  const auto parsed = std::from_chars(name.data() + before.size(), end, step);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return step;
}

std::optional<std::int64_t> step_of_checkpoint(const std::string& name) { return step_between(name, "step_", ".h5"); }

// Empty if this process may change the file, or add to the folder.
std::string why_not_writable(const fs::path& path) {
  const int mode = fs::is_directory(path) ? W_OK | X_OK : W_OK;
  return ::faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0 ? "" : std::strerror(errno);
}

}  // namespace

std::vector<std::string> RunFolder::names_of_records() { return {record_folders.begin(), record_folders.end()}; }

bool RunFolder::is_run_folder() const {
  std::error_code ignored;
  return fs::is_regular_file(case_file(), ignored) && read_text(case_file()).starts_with(case_marker);
}

void RunFolder::check_new(bool overwrite) const {
  std::error_code ignored;
  if (!fs::exists(path_, ignored)) return;
  if (!fs::is_directory(path_, ignored))
    throw InputError(
        fmt::format("{}: there is a file of this name; choose another folder with --out.", path_.string()));
  const std::vector<fs::path> entries = entries_of(path_);
  const bool has_something = std::any_of(entries.begin(), entries.end(), [](const fs::path& entry) {
    // Files of a run that was killed at once, or before it had removed an old one.
    return !is_left_by_a_kill(entry) && entry.filename() != FolderLock::file_name;
  });
  if (!has_something) return;
  if (!is_run_folder())
    throw InputError(
        fmt::format("{}: the folder holds something that is not a run of Thalweg and is left alone; choose "
                    "another folder with --out.",
                    path_.string()));
  if (!overwrite)
    throw InputError(
        fmt::format("{}: the folder holds a run already; choose another with --out, continue it with "
                    "--restart {}, or replace it with --overwrite.",
                    path_.string(), shell_word(path_.string())));
}

void RunFolder::check_writable() const {
  std::error_code ignored;
  fs::path above = fs::absolute(path_).lexically_normal();
  while (!fs::exists(above, ignored) && above.has_relative_path()) above = above.parent_path();
  if (const std::string why = why_not_writable(above); !why.empty() || !fs::is_directory(above, ignored))
    throw InputError(fmt::format("{}: cannot {} the folder: {}; choose another one with --out.", path_.string(),
                                 fs::exists(path_, ignored) ? "write to" : "create",
                                 why.empty() ? std::strerror(ENOTDIR) : why));
  std::vector<std::string> changed = names_of_records();
  changed.insert(changed.end(), added_to.begin(), added_to.end());
  for (const std::string& name : changed) {
    const std::string why = fs::exists(path_ / name, ignored) ? why_not_writable(path_ / name) : "";
    if (!why.empty())
      throw InputError(fmt::format("{}: cannot write to it: {}; change that or choose another folder with --out.",
                                   (path_ / name).string(), why));
  }
}

void RunFolder::create(bool overwrite) const {
  check_new(overwrite);
  make_folder(path_);
  std::vector<fs::path> old;
  for (const fs::path& entry : entries_of(path_))
    if (entry.filename().string().starts_with(kept_case) || is_left_by_a_kill(entry)) old.push_back(entry);
  // What would show that there have been checkpoints goes before them, and case.yaml, by which the folder is known,
  // last: an interrupted removal can be taken up again. A request to stop is taken away with the lock of the folder:
  // one that is there later concerns the run that begins.
  const auto add = [&](const auto& names) {
    for (const char* name : names) old.push_back(path_ / name);
  };
  add(made_of_the_run);
  add(replaced);
  old.push_back(log());
  add(record_folders);
  add(added_to);
  old.push_back(path_ / case_name);
  for (const fs::path& path : old) remove_entry(path);
}

void RunFolder::write_case(const std::string& comment_lines, const std::string& yaml) const {
  std::string text = std::string(case_marker) + " this is the case as it was run, with every default filled in.\n";
  std::size_t start = 0;
  while (start < comment_lines.size()) {
    const std::size_t end = std::min(comment_lines.find('\n', start), comment_lines.size());
    text += "# " + as_utf8(comment_lines.substr(start, end - start)) + "\n";
    start = end + 1;
  }
  write_text_durably(case_file(), text + yaml);
}

void RunFolder::go_on_from(std::int64_t step) const {
  if (fs::exists(checkpoint(step))) make_latest(step);
}

void RunFolder::make_latest(std::int64_t step) const {
  write_text_durably(checkpoints() / latest_name, checkpoint(step).filename().string() + "\n");
}

fs::path RunFolder::named_latest() const {
  const fs::path latest = checkpoints() / latest_name;
  std::error_code ignored;
  if (!fs::is_regular_file(latest, ignored)) return {};
  std::string name = read_text(latest);
  while (!name.empty() && (name.back() == '\n' || name.back() == ' ')) name.pop_back();
  return checkpoints() / name;
}

void RunFolder::keep_case(std::int64_t step) const {
  const fs::path kept = path_ / fmt::format("{}{}.yaml", kept_case, step), own = case_of(checkpoint(step));
  std::error_code ignored;
  if (own != kept && fs::is_regular_file(own, ignored)) write_text_durably(kept, read_text(own));
}

fs::path RunFolder::case_of(const fs::path& checkpoint) const {
  const std::optional<std::int64_t> step = step_of_checkpoint(checkpoint.filename().string());
  std::optional<std::int64_t> first;  // of the later steps until which a case was kept
  for (const fs::path& entry : entries_of(path_))
    if (const auto until = step_between(entry.filename().string(), kept_case, ".yaml");
        step && until && *until >= *step && (!first || *until < *first))
      first = until;
  return first ? path_ / fmt::format("{}{}.yaml", kept_case, *first) : case_file();
}

fs::path RunFolder::checkpoint(std::int64_t step) const { return checkpoints() / fmt::format("step_{}.h5", step); }

std::vector<std::int64_t> RunFolder::steps_of_checkpoints() const {
  std::vector<std::int64_t> steps;
  for (const fs::path& entry : entries_of(checkpoints()))
    if (const auto found = step_of_checkpoint(entry.filename().string())) steps.push_back(*found);
  std::sort(steps.rbegin(), steps.rend());
  return steps;
}

void RunFolder::rotate_checkpoints(std::int64_t step, int keep) const {
  // If the run continues from `step` and has not moved since, the case kept for it is still that of its state.
  const bool anew = named_latest() != checkpoint(step);
  make_latest(step);
  std::vector<fs::path> superfluous;
  int kept = 0;
  for (const std::int64_t found : steps_of_checkpoints())
    if (found > step || kept++ >= std::max(keep, 1)) superfluous.push_back(checkpoint(found));
  for (const fs::path& entry : entries_of(checkpoints()))
    if (is_left_by_a_kill(entry)) superfluous.push_back(entry);
  for (const fs::path& entry : entries_of(path_)) {
    const std::string name = entry.filename().string();
    const auto until = step_between(name, kept_case, ".yaml");
    if (is_left_by_a_kill(name) || (until && (*until > step || (*until == step && anew)))) superfluous.push_back(entry);
  }
  for (const fs::path& file : superfluous) remove_entry(file);
}

bool RunFolder::has_had_checkpoint() const {
  std::error_code ignored;
  const bool without_folder = fs::exists(log(), ignored) && !fs::exists(checkpoints(), ignored);
  return has_checkpoint() || fs::exists(checkpoints() / latest_name, ignored) || fs::exists(bed(), ignored) ||
         without_folder;
}

std::vector<fs::path> RunFolder::checkpoints_to_try() const {
  std::vector<fs::path> found;
  for (const std::int64_t step : steps_of_checkpoints()) found.push_back(checkpoint(step));
  if (found.empty())
    throw InputError(
        fmt::format("{}: the folder has no checkpoint ({}); give the path of a checkpoint or of a run that wrote one.",
                    path_.string(), (checkpoints() / "step_*.h5").string()));
  // Later ones than the latest are of a course that a restart has left.
  const auto named = std::find(found.begin(), found.end(), named_latest());
  if (named != found.end()) std::rotate(found.begin(), named, found.end());
  return found;
}

std::vector<fs::path> checkpoints_at(const fs::path& path) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return RunFolder(path).checkpoints_to_try();
  if (fs::exists(path, unknown) || unknown) return {path};  // what opens it says why it cannot be told
  throw InputError(
      fmt::format("{}: there is no such file or folder; give a checkpoint, for example "
                  "run/checkpoints/step_1000.h5, or a run folder.",
                  path.string()));
}

}  // namespace thalweg::io
