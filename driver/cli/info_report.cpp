#include "driver/cli/info_report.hpp"

#include "core/base/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/json_object.hpp"
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

// What a checkpoint says of itself.
struct CheckpointInfo {
  std::string path, name, system, version;
  double time, time_step;  // s
  std::int64_t step;
  std::vector<io::Hdf5Reader::Entry> datasets;
};

CheckpointInfo checkpoint_info(const fs::path& file) {
  io::Hdf5Reader archive(file);
  if (!archive.has("run/system"))
    throw InputError(fmt::format("{} is an HDF5 file but not a checkpoint of this program.", file.string()));
  return {file.string(),
          archive.text_attribute("run/name"),
          archive.text_attribute("run/system"),
          archive.text_attribute("run/version"),
          archive.real_attribute("run/time"),
          archive.real_attribute("run/time_step"),
          archive.integer_attribute("run/step"),
          archive.datasets()};
}

void add_checkpoint(const CheckpointInfo& c, Lines& lines) {
  lines.push_back(fmt::format("checkpoint  {}", c.path));
  lines.push_back(fmt::format("  run       {} (system: {}), written by version {}", c.name, c.system, c.version));
  lines.push_back(fmt::format("  state     {:.9g} s, step {} of {:.6g} s each", c.time, c.step, c.time_step));
  for (const io::Hdf5Reader::Entry& entry : c.datasets)
    lines.push_back(fmt::format("  {:<32} {:<8} {}", entry.path, entry.type, fmt::join(entry.shape, " x ")));
}

io::JsonObject as_json(const CheckpointInfo& c) {
  std::vector<io::JsonObject> datasets;
  for (const io::Hdf5Reader::Entry& entry : c.datasets)
    datasets.push_back(io::JsonObject()
                           .set("path", entry.path)
                           .set("type", entry.type)
                           .set("shape", std::vector<double>(entry.shape.begin(), entry.shape.end())));
  io::JsonObject object;
  object.set("path", c.path).set("name", c.name).set("system", c.system).set("version", c.version);
  object.set("time", c.time).set("step", c.step).set("time_step", c.time_step);
  return object.set("datasets", datasets);
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

// Runs of older versions have none.
void add_provenance(const YAML::Node& provenance, Lines& lines) {
  if (!provenance || !provenance.IsMap()) return;
  lines.push_back(fmt::format("started     {} on {} ({})", value(provenance, "started"), value(provenance, "host"),
                              value(provenance, "processor")));
  lines.push_back(fmt::format("built with  {} ({}); {}, HDF5 {}", value(provenance, "compiler"),
                              value(provenance, "compiler_flags"), value(provenance, "mpi"),
                              value(provenance, "hdf5")));
  for (const YAML::Node& input : provenance["inputs"])
    lines.push_back(fmt::format("input       {} = {}: SHA-256 {}", value(input, "key"), value(input, "path"),
                                value(input, "sha256")));
}

std::string state_of(const YAML::Node& summary) {
  return value(summary, "finished") == "true" ? "finished" : "not finished: " + value(summary, "reason");
}

void add_summary(const YAML::Node& summary, Lines& lines) {
  lines.push_back(fmt::format("run         {} (system: {}), version {}", value(summary, "name"),
                              value(summary, "system"), value(summary, "version")));
  lines.push_back("state       " + state_of(summary));
  lines.push_back(fmt::format("time        {} of {} s, {} steps", rounded(summary, "simulated_time"),
                              value(summary, "until"), value(summary, "steps")));
  lines.push_back(fmt::format("size        {} cells, {} grains; {} rank{} ({})", value(summary, "cells"),
                              value(summary, "grains"), value(summary, "ranks"),
                              value(summary, "ranks") == "1" ? "" : "s", value(summary, "layout")));
  lines.push_back(
      fmt::format("speed       {} steps/s, {} MLUPS", rounded(summary, "steps_per_second"), rounded(summary, "mlups")));
  add_provenance(summary["provenance"], lines);
  lines.push_back("results");
  for (const auto& entry : summary)
    if (const std::string& name = entry.first.Scalar();
        entry.second.IsMap() && name != "phases" && name != "largest" && name != "units" && name != "provenance")
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
    add_checkpoint(checkpoint_info(path), lines);
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
    add_checkpoint(checkpoint_info(folder.latest_checkpoint()), lines);
  else
    lines.push_back("checkpoint  none yet");
  return lines;
}

std::string info_json(const fs::path& path) {
  io::JsonObject object;
  object.set("path", path.string());
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return object.set("checkpoint", as_json(checkpoint_info(path))).text() + "\n";
  const io::RunFolder folder(path);
  require_run_folder(folder);
  const YAML::Node summary = summary_in(folder);
  object.set("state", summary.IsMap() ? state_of(summary) : state_without_summary(folder));
  object.set_json("summary", summary.IsMap() ? io::read_text(folder.summary()) : "null");
  object.set("last_line", fs::exists(folder.log(), ignored) ? last_line(folder.log()) : "");
  if (folder.has_checkpoint())
    object.set("checkpoint", as_json(checkpoint_info(folder.latest_checkpoint())));
  else
    object.set_json("checkpoint", "null");
  return object.text() + "\n";
}

}  // namespace thalweg::driver
