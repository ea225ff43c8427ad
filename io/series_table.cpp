#include "io/series_table.hpp"

#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "io/atomic_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>

namespace thalweg::io {
namespace {

std::string header_of(const std::vector<SeriesTable::Column>& columns) {
  std::string header = "time [s]";
  for (const auto& column : columns) header += fmt::format(",{} [{}]", column.name, column.unit);
  return header + "\n";
}

// The rows of an existing file up to a time. A last line without its newline was being written when the run ended.
std::string kept_rows(const std::string& text, std::size_t start, double continue_from) {
  std::string rows;
  while (start < text.size()) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos) break;
    double time = 0.0;
    const auto parsed = std::from_chars(text.data() + start, text.data() + end, time);
    if (parsed.ec == std::errc() && time <= continue_from) rows += text.substr(start, end + 1 - start);
    start = end + 1;
  }
  return rows;
}

// Whether the file can be continued with rows under this header; an empty file can.
bool has_other_columns(const std::string& text, const std::string& header) {
  return !text.empty() && !text.starts_with(header);
}

void refuse_other_columns(const std::filesystem::path& path, std::string header) {
  header.pop_back();  // the end of the line
  throw InputError(
      fmt::format("{}: the file has other columns than this run writes ({}); restart into another folder "
                  "with --out.",
                  path.string(), header));
}

}  // namespace

void SeriesTable::check_columns(MPI_Comm communicator, const std::filesystem::path& path,
                                const std::vector<Column>& columns) {
  bool other = false;
  std::error_code ignored;
  if (rank_of(communicator) == 0 && std::filesystem::exists(path, ignored)) {
    try {
      other = has_other_columns(read_text(path), header_of(columns));
    } catch (const std::runtime_error&) {  // the constructor will say that it cannot be used
    }
  }
  if (any_rank(communicator, other)) refuse_other_columns(path, header_of(columns));
}

SeriesTable::SeriesTable(MPI_Comm communicator, std::filesystem::path path, std::vector<Column> columns,
                         std::optional<double> continue_from)
    : communicator_(communicator), path_(std::move(path)), columns_(std::move(columns)) {
  enum Outcome { good, cannot_write, other_columns };
  int outcome = good;
  if (rank_of(communicator_) == 0) {
    try {
      const std::string header = header_of(columns_);
      std::string rows;
      if (continue_from && std::filesystem::exists(path_)) {
        const std::string text = read_text(path_);
        if (has_other_columns(text, header))
          outcome = other_columns;
        else if (!text.empty())
          rows = kept_rows(text, header.size(), *continue_from);
      }
      if (outcome == good) {
        write_text_atomically(path_, header + rows);
        file_.open(path_, std::ios::binary | std::ios::app);
        if (!file_) outcome = cannot_write;
      }
    } catch (const std::runtime_error&) {
      outcome = cannot_write;
    }
  }
  MPI_Bcast(&outcome, 1, MPI_INT, 0, communicator_);
  if (outcome == other_columns) refuse_other_columns(path_, header_of(columns_));
  throw_if_failed(outcome == cannot_write);
}

void SeriesTable::append(double time, std::span<const double> values) {
  if (rank_of(communicator_) == 0) {
    std::string row = fmt::format("{}", time);
    for (const double value : values) row += fmt::format(",{}", value);
    file_ << row << '\n';
    file_.flush();
  }
  throw_if_failed(rank_of(communicator_) == 0 && !file_);
}

void SeriesTable::put_on_disk() { throw_if_failed(rank_of(communicator_) == 0 && !io::put_on_disk(path_)); }

void SeriesTable::throw_if_failed(bool failed) const {
  if (any_rank(communicator_, failed))
    throw RunError(
        fmt::format("{}: cannot write the series; is the disk full or the folder write-protected?", path_.string()));
}

}  // namespace thalweg::io
