// The folder of one run: what lies where in it, and checks that nothing of the user's is lost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::io {

// Plain paths and file operations; called by one rank (the others may hold a RunFolder for its paths).
class RunFolder {
public:
  // The folder `path`, whether it exists or not.
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

  // True if this is a folder some run wrote: its case.yaml begins with case_marker.
  bool is_run_folder() const;

  // Makes the folder ready for a new run. Throws InputError if something is there already: a run without `overwrite`,
  // or anything that is not a run in any case. With `overwrite` only what a run writes is removed, and nothing else.
  // check_new() only checks, so that a bad case can be refused before anything is written. RunError where the folder
  // cannot be listed.
  void check_new(bool overwrite) const;
  void create(bool overwrite) const;

  // Throws InputError where a run could not write: the folder or what it would add to in it (checkpoints, pictures,
  // records, log); where the folder does not exist, the nearest one above it that does.
  void check_writable() const;

  // Writes case.yaml: the marker, the given lines as comments (version, command), the case. Throws RunError.
  void write_case(const std::string& comment_lines, const std::string& yaml) const;
  static constexpr const char* case_marker = "# Thalweg run:";

  // Makes the checkpoint of `step`, if the folder has it, the latest: a restart has gone back to it, and later ones
  // belong to an abandoned course. Throws RunError.
  void go_on_from(std::int64_t step) const;

  // Keeps the case of the checkpoint of `step` (case_of), as the run may go on from there with another one:
  // case_until_step_<step>.yaml, unless it is there already. Throws RunError.
  void keep_case(std::int64_t step) const;

  // The case with which the state of one of the folder's checkpoints was computed: a kept one, or the present one.
  std::filesystem::path case_of(const std::filesystem::path& checkpoint) const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path case_file() const { return path_ / "case.yaml"; }
  std::filesystem::path log() const { return path_ / "run.log"; }
  std::filesystem::path series() const { return path_ / "series.csv"; }
  std::filesystem::path profiles() const { return path_ / "profiles.h5"; }
  static std::vector<std::string> names_of_records();  // of the observers that have some
  std::filesystem::path records(const std::string& observer) const { return path_ / observer; }  // a folder
  std::filesystem::path bed() const { return path_ / "bed.h5"; }
  std::filesystem::path fluid_parts() const { return path_ / "fluid_parts"; }
  std::filesystem::path grain_parts() const { return path_ / "grain_parts"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path stop() const { return path_ / "stop"; }  // asks the run to stop
  std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  std::filesystem::path checkpoint(std::int64_t step) const;  // checkpoints/step_<step>.h5

  // Rotates the checkpoints after that of `step` has been closed: makes it the latest (checkpoints/latest holds its
  // file name), and removes all but the newest `keep` of those up to `step`, any later ones, which a restart from an
  // earlier time has made obsolete, the cases kept for them and, if `step` was computed anew, for an earlier state of
  // it, and half-written files of killed runs. Throws RunError.
  void rotate_checkpoints(std::int64_t step, int keep) const;

  bool has_checkpoint() const { return !steps_of_checkpoints().empty(); }

  // True also where they have been removed since, as far as that can still be seen.
  bool has_had_checkpoint() const;

  // The checkpoints to go on from, the best first: the latest, as far as that is known, then those before it from new
  // to old, then those after it. InputError if there is none.
  std::vector<std::filesystem::path> checkpoints_to_try() const;
  std::filesystem::path latest_checkpoint() const { return checkpoints_to_try().front(); }

private:
  std::vector<std::int64_t> steps_of_checkpoints() const;  // from new to old
  void make_latest(std::int64_t step) const;               // writes checkpoints/latest
  std::filesystem::path named_latest() const;              // the checkpoint it names; empty where there is no such file

  std::filesystem::path path_;
};

// The checkpoints a `--restart PATH` means, the best first: the file itself, or those of a run folder. Throws
// InputError.
std::vector<std::filesystem::path> checkpoints_at(const std::filesystem::path& path);
inline std::filesystem::path checkpoint_at(const std::filesystem::path& path) { return checkpoints_at(path).front(); }

}  // namespace thalweg::io
