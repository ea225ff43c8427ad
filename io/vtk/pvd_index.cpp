#include "io/vtk/pvd_index.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/interrupted_call.hpp"
#include "io/vtk/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace thalweg::io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view first_lines =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
constexpr std::string_view last_lines = "  </Collection>\n</VTKFile>\n";

std::string line_of(const PvdIndex::Entry& entry) {
  return fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time, entry.file);
}

// Text between quotes behind a mark.
std::optional<std::string> quoted(std::string_view text, std::string_view mark) {
  const std::size_t start = text.find(mark);
  if (start == std::string_view::npos) return std::nullopt;
  const std::size_t from = start + mark.size(), end = text.find('"', from);
  if (end == std::string_view::npos) return std::nullopt;
  return std::string(text.substr(from, end - from));
}

// Complete entries.
std::vector<PvdIndex::Entry> entries_in(std::string_view text) {
  constexpr std::string_view begins = "<DataSet ";
  std::vector<PvdIndex::Entry> entries;
  for (std::size_t at = text.find(begins); at != std::string_view::npos;) {
    const std::size_t next = text.find(begins, at + begins.size());
    std::string_view element = text.substr(at, next == std::string_view::npos ? next : next - at);
    at = next;
    const std::size_t end = element.find("/>");
    if (end == std::string_view::npos) continue;
    element = element.substr(0, end);
    const auto time_text = quoted(element, "timestep=\""), file = quoted(element, "file=\"");
    double time = 0.0;
    if (time_text && file &&
        std::from_chars(time_text->data(), time_text->data() + time_text->size(), time).ec == std::errc())
      entries.push_back({time, *file});
  }
  return entries;
}

// Writes text into an existing file of `size` bytes from `offset` on. False if the file is not there, has another size
// or cannot be written; it may then end in the midst of the text.
bool write_at(const fs::path& path, std::uint64_t size, std::uint64_t offset, std::string_view text) {
  std::error_code ignored;
  if (fs::file_size(path, ignored) != size) return false;
  const int file = opened(path, O_WRONLY);
  if (file < 0) return false;
  const ssize_t written =
      repeated_if_interrupted([&] { return ::pwrite(file, text.data(), text.size(), static_cast<off_t>(offset)); });
  return (::close(file) == 0 || errno == EINTR) && written == static_cast<ssize_t>(text.size());
}

}  // namespace

PvdIndex::PvdIndex(MPI_Comm communicator, fs::path path, std::optional<double> continue_from)
    : communicator_(communicator), path_(std::move(path)) {
  if (continue_from) on_first_rank(communicator_, [&] { take_up(*continue_from); });
}

void PvdIndex::take_up(double until) {
  std::error_code ignored;
  const bool is_there = fs::exists(path_, ignored);
  const std::string text = is_there ? read_text(path_) : std::string();
  std::map<std::string, double> listed;
  for (const Entry& entry : entries_in(text)) {
    listed[entry.file] = entry.time;
    if (entry.time <= until) entries_.push_back(entry);
  }
  const fs::path name = path_.stem();
  std::vector<fs::path> later;
  for (const fs::path& frame : entries_of(path_.parent_path() / name)) {
    if (!frame.filename().string().starts_with(name.string() + "_")) continue;
    const std::string file = (name / frame.filename()).generic_string();
    const auto known = listed.find(file);
    const std::optional<double> time = known != listed.end() ? known->second : VtkXmlFile::time_in(frame);
    if (is_left_by_a_kill(frame) || (time && *time > until))
      later.push_back(frame);
    else if (time && known == listed.end())
      entries_.push_back({*time, file});
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  if (is_there || !entries_.empty()) rewrite();
  std::for_each(later.begin(), later.end(), remove_entry);
}

void PvdIndex::add(double time, const fs::path& file) {
  on_first_rank(communicator_, [&] {
    const Entry entry{time, file.generic_string()};
    new_files_.push_back(path_.parent_path() / file);
    if (!entries_.empty() && time > entries_.back().time && end_of_entries_ > 0) return append(entry);
    std::erase_if(entries_, [time](const Entry& other) { return other.time == time; });
    const auto behind = std::upper_bound(entries_.begin(), entries_.end(), time,
                                         [](double at, const Entry& other) { return at < other.time; });
    entries_.insert(behind, entry);
    rewrite();
  });
}

void PvdIndex::append(const Entry& entry) {
  entries_.push_back(entry);
  const std::string line = line_of(entry);
  if (!write_at(path_, end_of_entries_ + last_lines.size(), end_of_entries_, line + std::string(last_lines)))
    return rewrite();  // somebody has changed the file, or what is wrong with the disk is said
  end_of_entries_ += line.size();
}

void PvdIndex::rewrite() {
  std::string text(first_lines);
  for (const Entry& entry : entries_) text += line_of(entry);
  end_of_entries_ = text.size();
  write_text_durably(path_, text + std::string(last_lines));
}

void PvdIndex::put_on_disk() {
  on_first_rank(communicator_, [&] {
    if (new_files_.empty()) return;
    std::set<fs::path> all(new_files_.begin(), new_files_.end());
    for (const fs::path& file : new_files_) all.insert(file.parent_path());
    all.insert(path_);
    for (const fs::path& path : all)
      if (!io::put_on_disk(path))
        throw RunError(fmt::format("{}: cannot write the file; is the disk full?", path.string()));
    new_files_.clear();
  });
}

void take_up_indices(MPI_Comm communicator, const fs::path& folder, double continue_from) {
  on_first_rank(communicator, [&] {
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const fs::path& entry : entries_of(folder))
      if (entry.extension() == ".pvd" && fs::is_directory(folder / entry.stem(), ignored)) found.push_back(entry);
    for (const fs::path& path : found) PvdIndex(MPI_COMM_SELF, path, continue_from);
  });
}

}  // namespace thalweg::io
