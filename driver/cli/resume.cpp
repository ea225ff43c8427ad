#include "driver/cli/resume.hpp"

#include "core/base/error.hpp"
#include "driver/cli/info_report.hpp"
#include "io/files/atomic_file.hpp"
#include "io/text/yaml_document.hpp"
#include "loop/time_loop.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

namespace thalweg::driver {
namespace {

namespace fs = std::filesystem;

// Until when a run has been finished, s; nothing of one that has not, or whose summary a crash has left half written.
std::optional<double> finished_until(const io::RunFolder& folder) {
  const YAML::Node summary = whole_summary_in(folder);
  if (!summary.IsMap() || !summary["finished"].as<bool>(false)) return {};
  return summary["until"].as<double>(-std::numeric_limits<double>::infinity());
}

bool is_finished(const io::RunFolder& folder, double until) {
  const std::optional<double> end = finished_until(folder);
  return end && until <= *end * (1.0 + loop::rounding_of_the_end);
}

// True for a run that went on from another one, by the command in the head of its case.
bool was_restarted(const io::RunFolder& folder) {
  std::istringstream text(io::read_text(folder.case_file()));
  for (std::string line; std::getline(text, line) && line.starts_with("#");)
    if (line.starts_with("# command") && line.find(" --restart") != std::string::npos) return true;
  return false;
}

}  // namespace

double wanted_end(const fs::path& case_file, const std::vector<std::string>& settings) {
  const io::YamlDocument document(case_file, settings);
  double end = std::numeric_limits<double>::infinity();
  if (const io::YamlNode* until = document.find("run.until")) {
    double value = 0.0;
    const char *first = until->text.data(), *last = first + until->text.size();
    const auto parsed = std::from_chars(first + (until->text.starts_with('+') ? 1 : 0), last, value);
    if (parsed.ec == std::errc() && parsed.ptr == last) end = value;
  }
  return end;
}

Resumption resumption_of(const io::RunFolder& folder, double until, io::FolderLock& lock) {
  if (!folder.is_run_folder()) return Resumption::begin;
  if (is_finished(folder, until)) return Resumption::finished;
  lock = io::FolderLock(folder.path());
  if (is_finished(folder, until)) return Resumption::finished;  // by whoever had the lock
  std::error_code ignored;
  if (fs::remove(folder.stop(), ignored)) return Resumption::asked_to_stop;
  if (folder.has_checkpoint()) return Resumption::go_on;
  if (folder.has_had_checkpoint() || finished_until(folder))
    throw InputError(
        fmt::format("{}: the run in it has not reached {:g} s and cannot continue, as its checkpoints have been "
                    "removed; it is left alone: choose another folder with --out, or replace it with --overwrite.",
                    folder.path().string(), until));
  if (was_restarted(folder))
    throw InputError(
        fmt::format("{}: the run in it was begun with --restart and has ended before it could save; it is left alone: "
                    "give that --restart again, with --overwrite in place of --resume.",
                    folder.path().string()));
  return Resumption::begin_again;
}

}  // namespace thalweg::driver
