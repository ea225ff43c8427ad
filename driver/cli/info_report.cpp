#include "driver/cli/info_report.hpp"

#include "core/base/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/folder/folder_lock.hpp"
#include "io/folder/run_folder.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "loop/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <optional>

namespace thalweg::driver {

namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

void add_checkpoint(const fs::path& file, Lines& lines) {
  io::Hdf5Reader archive(file);
  if (!archive.has("run/system"))
    throw InputError(fmt::format("{} is an HDF5 file but not a checkpoint of this program.", file.string()));
  lines.push_back(fmt::format("checkpoint  {}", file.string()));
  lines.push_back(fmt::format("  run       {} (system: {}), written by version {}", archive.text_attribute("run/name"),
                              archive.text_attribute("run/system"), archive.text_attribute("run/version")));
  lines.push_back(fmt::format("  state     {:.9g} s, step {} of {:.6g} s each", archive.real_attribute("run/time"),
                              archive.integer_attribute("run/step"), archive.real_attribute("run/time_step")));
  for (const io::Hdf5Reader::Entry& entry : archive.datasets())
    lines.push_back(fmt::format("  {:<32} {:<8} {}", entry.path, entry.type, fmt::join(entry.shape, " x ")));
}

// A scalar of summary.json; empty if it is not there.
std::string value(const YAML::Node& summary, const std::string& name) {
  const YAML::Node node = summary[name];
  return node && node.IsScalar() ? node.Scalar() : "";
}

void add_group(const YAML::Node& group, const std::string& title, const YAML::Node& units, Lines& lines) {
  for (const auto& entry : group) {
    const auto name = entry.first.as<std::string>();
    const std::string unit = units.IsMap() ? value(units, name) : "";
    lines.push_back(fmt::format("  {:<36} {}{}", fmt::format("{}.{}", title, name),
                                entry.second.IsScalar() ? entry.second.Scalar() : "-",
                                unit.empty() || unit == "1" ? "" : " " + unit));
  }
}

// A number of the summary as a person reads it.
std::string rounded(const YAML::Node& summary, const std::string& name) {
  const YAML::Node node = summary[name];
  double number = 0.0;
  return node && YAML::convert<double>::decode(node, number) ? fmt::format("{:.6g}", number) : value(summary, name);
}

void add_summary(const YAML::Node& summary, Lines& lines) {
  const bool finished = value(summary, "finished") == "true";
  lines.push_back(fmt::format("run         {} (system: {}), version {}", value(summary, "name"),
                              value(summary, "system"), value(summary, "version")));
  lines.push_back(fmt::format("state       {}", finished ? "finished" : "not finished: " + value(summary, "reason")));
  lines.push_back(fmt::format("time        {} of {} s, {} steps", rounded(summary, "simulated_time"),
                              value(summary, "until"), value(summary, "steps")));
  lines.push_back(fmt::format("size        {} cells, {} grains; {} rank{} ({})", value(summary, "cells"),
                              value(summary, "grains"), value(summary, "ranks"),
                              value(summary, "ranks") == "1" ? "" : "s", value(summary, "layout")));
  lines.push_back(
      fmt::format("speed       {} steps/s, {} MLUPS", rounded(summary, "steps_per_second"), rounded(summary, "mlups")));
  lines.push_back("results");
  for (const auto& entry : summary)
    if (const std::string& name = entry.first.Scalar();
        entry.second.IsMap() && name != "phases" && name != "largest" && name != "units")
      add_group(entry.second, name, summary["units"], lines);
}

// The last line of a file that may be long, of which only the end is read; empty if it cannot be read.
std::string last_line(const fs::path& file) {
  constexpr std::streamoff most_bytes = 1 << 16;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream.tellg();
  if (size <= 0) return {};
  std::string text(static_cast<std::size_t>(std::min(size, most_bytes)), '\0');
  stream.seekg(-static_cast<std::streamoff>(text.size()), std::ios::end);
  if (!stream.read(text.data(), static_cast<std::streamsize>(text.size()))) return {};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.find_last_of('\n') + 1);
}

}  // namespace

void require_run_folder(const io::RunFolder& folder) {
  if (!folder.is_run_folder())
    throw InputError(
        fmt::format("{} is neither a run folder nor a checkpoint: give a folder that thalweg run has written, "
                    "or an .h5 file in its checkpoints.",
                    folder.path().string()));
}

// JSON is YAML, so the reader is at hand.
YAML::Node summary_in(const io::RunFolder& folder) {
  std::error_code ignored;
  if (!fs::exists(folder.summary(), ignored)) return {};
  try {
    return YAML::Load(io::read_text(folder.summary()));
  } catch (const YAML::Exception&) {
    throw InputError(fmt::format("{} is damaged: it is not JSON.", folder.summary().string()));
  }
}

YAML::Node whole_summary_in(const io::RunFolder& folder) {
  try {
    const YAML::Node summary = summary_in(folder);
    if (summary.IsMap()) return summary;
  } catch (const InputError&) {
  }
  return {};
}

std::string state_without_summary(const io::RunFolder& folder) {
  const std::optional<bool> held = io::FolderLock::is_held(folder.path());
  if (!held) return "running, or killed without notice";
  return *held ? "running" : "not running: it was killed, or it failed and could not write a summary";
}

std::vector<std::string> info_report(const fs::path& path) {
  Lines lines;
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) {
    add_checkpoint(path, lines);
    return lines;
  }
  const io::RunFolder folder(path);
  require_run_folder(folder);
  if (const YAML::Node summary = summary_in(folder); summary.IsMap())
    add_summary(summary, lines);
  else
    lines.push_back("state       " + state_without_summary(folder));
  if (fs::exists(folder.log(), ignored)) lines.push_back("last line   " + last_line(folder.log()));
  if (folder.has_checkpoint())
    add_checkpoint(folder.latest_checkpoint(), lines);
  else
    lines.push_back("checkpoint  none yet");
  return lines;
}

}  // namespace thalweg::driver
