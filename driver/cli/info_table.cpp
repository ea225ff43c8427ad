#include "driver/cli/info_table.hpp"

#include "driver/cli/info_report.hpp"
#include "io/folder/run_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace thalweg::driver {

namespace {

// Columns in the order in which they are first met, and a row's values by column.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::map<std::string, std::string>> rows;

  void set(const std::string& column, const std::string& value) {
    if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
    rows.back()[column] = value;
  }
};

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string with_unit(const std::string& column, const std::string& name, const YAML::Node& units) {
  const YAML::Node unit = units ? units[name] : YAML::Node();
  return unit && unit.IsScalar() && unit.Scalar() != "1" ? fmt::format("{} [{}]", column, unit.Scalar()) : column;
}

void add_summary(const YAML::Node& summary, Table& table) {
  const YAML::Node units = summary["units"];
  for (const auto& entry : summary) {
    const std::string name = entry.first.Scalar();
    if (name == "finished" || name == "reason" || name == "phases" || name == "units" || name == "provenance") continue;
    if (entry.second.IsScalar()) table.set(with_unit(name, name, units), entry.second.Scalar());
    if (!entry.second.IsMap()) continue;
    for (const auto& diagnostic : entry.second) {
      const std::string own = diagnostic.first.Scalar();
      table.set(with_unit(fmt::format("{}.{}", name, own), own, units),
                diagnostic.second.IsScalar() ? diagnostic.second.Scalar() : "");
    }
  }
}

}  // namespace

// The run folders that a path of the command line stands for: itself, or the runs of a sweep. Files beside other paths,
// as a sweep has them beside its runs, stand for none.
static std::vector<std::string> runs_of(const std::string& path, bool alone) {
  const std::filesystem::path folder(path), of_sweep = folder / "runs";
  std::error_code ignored;
  if (!alone && std::filesystem::is_regular_file(folder, ignored)) return {};
  if (io::RunFolder(folder).is_run_folder() || !std::filesystem::is_directory(of_sweep, ignored)) return {path};
  std::vector<std::string> runs;
  for (const auto& entry : std::filesystem::directory_iterator(of_sweep, ignored))
    if (io::RunFolder(entry.path()).is_run_folder()) runs.push_back(entry.path().string());
  std::sort(runs.begin(), runs.end());
  return runs;
}

std::vector<std::string> info_table(const std::vector<std::string>& paths) {
  std::vector<std::string> runs;
  for (const std::string& path : paths)
    for (const std::string& run : runs_of(path, paths.size() == 1)) runs.push_back(run);
  Table table;
  for (const std::string& run : runs) {
    const io::RunFolder folder(run);
    require_run_folder(folder);
    table.rows.emplace_back();
    table.set("run", run);
    const YAML::Node summary = summary_in(folder);
    if (!summary.IsMap()) {
      table.set("state", state_without_summary(folder));
      continue;
    }
    const bool finished = summary["finished"].as<bool>(false);
    table.set("state", finished ? "finished" : "not finished: " + summary["reason"].as<std::string>(""));
    add_summary(summary, table);
  }
  std::vector<std::string> headings;
  for (const std::string& column : table.columns) headings.push_back(quoted(column));
  std::vector<std::string> lines{fmt::format("{}", fmt::join(headings, ","))};
  for (const auto& row : table.rows) {
    std::vector<std::string> values;
    for (const std::string& column : table.columns) {
      const auto value = row.find(column);
      values.push_back(value == row.end() ? "" : quoted(value->second));
    }
    lines.push_back(fmt::format("{}", fmt::join(values, ",")));
  }
  return lines;
}

}  // namespace thalweg::driver
