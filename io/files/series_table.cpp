#include "io/files/series_table.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace thalweg::io {
namespace {

// The text of a file as the program writes it, without what other programs add: a byte-order mark, and the ends of
// lines of Windows.
std::string plain_text(const std::filesystem::path& path) {
  std::string text = read_text(path);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::erase(text, '\r');
  return text;
}

struct KeptRows {
  std::string text;
  std::vector<double> times;  // s
};

// Rows of an existing file up to a time. A last line without its newline was cut short by the end of the run.
KeptRows kept_rows(const std::string& text, std::size_t start, double continue_from) {
  KeptRows rows;
  while (start < text.size()) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos) break;
    double time = 0.0;
    const auto parsed = std::from_chars(text.data() + start, text.data() + end, time);
    if (parsed.ec == std::errc() && time <= continue_from) {
      rows.text += text.substr(start, end + 1 - start);
      rows.times.push_back(time);
    }
    start = end + 1;
  }
  return rows;
}

// Rows come at even times, but for one at the end of a run and the next: none is missing if the last is less than one
// and a half of the longest of the three latest intervals ago.
std::string gap_after(const std::vector<double>& times, double continue_from) {
  double interval = 0.0;
  for (std::size_t n = times.size(); n-- > 1 && n + 3 >= times.size();)
    interval = std::max(interval, times[n] - times[n - 1]);
  if (interval == 0.0 || continue_from < times.back() + 1.5 * interval) return {};
  return fmt::format("the rows of series.csv end at {:g} s, and those from there to {:g} s are missing", times.back(),
                     continue_from);
}

std::string cannot_write_series(const std::filesystem::path& path) {
  return fmt::format("{}: cannot write the series; is the disk full or the folder write-protected?", path.string());
}

std::vector<std::string> columns_in(const std::string& header) {
  std::vector<std::string> columns;
  std::istringstream line(header.substr(0, header.find('\n')));
  for (std::string column; std::getline(line, column, ',');) columns.push_back(column);
  return columns;
}

// Those of the first that are not among the second.
std::vector<std::string> without(const std::vector<std::string>& columns, const std::vector<std::string>& others) {
  std::vector<std::string> left;
  std::copy_if(columns.begin(), columns.end(), std::back_inserter(left), [&](const std::string& column) {
    return std::find(others.begin(), others.end(), column) == others.end();
  });
  return left;
}

// What tells the columns of a file from those of a run, in words.
std::string difference(const std::string& in_file, const std::string& in_run) {
  const std::vector<std::string> file = columns_in(in_file), run = columns_in(in_run);
  const std::vector<std::string> lost = without(file, run), added = without(run, file);
  if (lost.empty() && added.empty()) return "in another order";
  std::string text;
  if (!added.empty()) text = fmt::format("without {}", fmt::join(added, ", "));
  if (!lost.empty()) text += fmt::format("{}with {}", text.empty() ? "" : ", ", fmt::join(lost, ", "));
  return text;
}

// Throws InputError if the text of a file does not begin with this header; an empty file can be continued.
void refuse_other_columns(const std::filesystem::path& path, const std::string& text, const std::string& header) {
  if (text.empty() || text.starts_with(header)) return;
  throw InputError(
      fmt::format("{}: the file has other columns than this run writes, {}; restart into another folder with --out.",
                  path.string(), difference(text, header)));
}

// Does work with the file on rank 0. Any error but an InputError means that the file cannot be written.
void act(MPI_Comm communicator, const std::filesystem::path& path, const std::function<void()>& work) {
  on_first_rank(communicator, [&] {
    try {
      work();
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error&) {
      throw RunError(cannot_write_series(path));
    }
  });
}

}  // namespace

void SeriesTable::check_columns(MPI_Comm communicator, const std::filesystem::path& path,
                                const SeriesColumns& columns) {
  act(communicator, path, [&] {
    if (std::filesystem::exists(path)) refuse_other_columns(path, plain_text(path), columns.header() + "\n");
  });
}

void SeriesTable::drop_rows_after(MPI_Comm communicator, const std::filesystem::path& path, double time) {
  act(communicator, path, [&] {
    if (!std::filesystem::exists(path)) return;
    const std::string text = plain_text(path);
    const std::size_t end = text.find('\n');  // of the header
    if (end != std::string::npos)
      write_text_durably(path, text.substr(0, end + 1) + kept_rows(text, end + 1, time).text);
  });
}

SeriesTable::SeriesTable(MPI_Comm communicator, std::filesystem::path path, SeriesColumns columns,
                         std::optional<double> continue_from)
    : communicator_(communicator), path_(std::move(path)), columns_(std::move(columns)) {
  act(communicator_, path_, [&] {
    const std::string header = columns_.header() + "\n";
    std::string rows;
    if (continue_from && std::filesystem::exists(path_)) {
      const std::string text = plain_text(path_);
      refuse_other_columns(path_, text, header);
      if (!text.empty()) {
        const KeptRows kept = kept_rows(text, header.size(), *continue_from);
        rows = kept.text;
        gap_ = gap_after(kept.times, *continue_from);
      }
    }
    write_text_durably(path_, header + rows);
    file_.open(path_, std::ios::binary | std::ios::app);
    if (!file_) throw RunError(cannot_write_series(path_));
  });
}

void SeriesTable::append(double time, std::span<const Diagnostic> row) {
  const std::vector<double> values = columns_.values_of(row);
  if (rank_of(communicator_) == 0) {
    std::string line = fmt::format("{}", time);
    for (const double value : values) line += fmt::format(",{}", value);
    file_ << line << '\n';
    file_.flush();
  }
  throw_if_failed(rank_of(communicator_) == 0 && !file_);
}

void SeriesTable::put_on_disk() { throw_if_failed(rank_of(communicator_) == 0 && !io::put_on_disk(path_)); }

void SeriesTable::throw_if_failed(bool failed) const {
  if (any_rank(communicator_, failed)) throw RunError(cannot_write_series(path_));
}

}  // namespace thalweg::io
