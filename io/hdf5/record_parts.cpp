#include "io/hdf5/record_parts.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/labelled_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_kept_bytes = std::size_t{16} << 20;  // between two checkpoints
constexpr std::string_view before_step = "part_", after_step = ".h5";

std::optional<std::int64_t> step_of_part(const std::string& name) {
  if (!name.starts_with(before_step) || !name.ends_with(after_step)) return std::nullopt;
  std::int64_t step = 0;
  const char* end = name.data() + name.size() - after_step.size();
  const auto parsed = std::from_chars(name.data() + before_step.size(), end, step);
  return parsed.ec == std::errc() && parsed.ptr == end ? std::optional(step) : std::nullopt;
}

// The last part up to a step; empty path: there is none.
fs::path last_part(const fs::path& folder, std::int64_t until) {
  std::int64_t last = -1;
  fs::path path;
  for (const fs::path& entry : entries_of(folder))
    if (const auto step = step_of_part(entry.filename().string()); step && *step <= until && *step > last)
      last = *step, path = entry;
  return path;
}

ArrayBox whole(const std::vector<std::uint64_t>& shape) {
  return {shape, std::vector<std::uint64_t>(shape.size(), 0), shape};
}

void write(Hdf5Writer& file, ArrayLabeller& arrays, const Event& event) {
  const std::string group = event.name + "/";
  file.attribute(group + "time", event.time);
  file.attribute(group + "time_units", std::string("s"));
  for (const Diagnostic& diagnostic : event.diagnostics) {
    file.attribute(group + diagnostic.name, diagnostic.value);
    file.attribute(group + diagnostic.name + "_units", diagnostic.unit);
  }
  for (const WholeNumbers& numbers : event.numbers) arrays.write(event.name, numbers);
  for (const Profile& array : event.arrays) arrays.write(event.name, array);
}

std::size_t bytes_of(const Records& records) {
  std::size_t numbers = 0;
  for (const Profile& array : records.rows) numbers += array.values.size();
  for (const Event& event : records.events) {
    numbers += 1 + event.diagnostics.size();
    for (const WholeNumbers& list : event.numbers) numbers += list.values.size();
    for (const Profile& array : event.arrays) numbers += array.values.size();
  }
  return numbers * sizeof(double);
}

bool has_fixed(Hdf5Reader& file, const WholeNumbers& numbers) {
  if (!file.has(numbers.name) || file.shape(numbers.name) != std::vector<std::uint64_t>{numbers.values.size()})
    return false;
  std::vector<std::int64_t> found(numbers.values.size());
  file.read(numbers.name, std::span<std::int64_t>(found), whole({found.size()}));
  return found == numbers.values;
}

bool has_places(Hdf5Reader& file, const Profile& array) {
  if (!file.has(array.name) || file.shape(array.name) != array.shape) return false;
  std::vector<double> found(array.values.size());
  file.read(array.name, std::span<double>(found), whole(array.shape));
  return found == array.values;
}

bool has_rows(Hdf5Reader& file, const Profile& array) {
  const std::vector<std::uint64_t> found = file.has(array.name) ? file.shape(array.name) : std::vector<std::uint64_t>();
  return !found.empty() && found.size() == array.shape.size() &&
         std::equal(found.begin() + 1, found.end(), array.shape.begin() + 1);
}

// Why a run with such records cannot go on with a part; empty: it can.
std::string mismatch(const fs::path& path, const Records& records) {
  try {
    Hdf5Reader file(path);
    for (const WholeNumbers& numbers : records.fixed)
      if (!has_fixed(file, numbers)) return fmt::format("its {} is not that of this run", numbers.name);
    for (const Profile& array : records.places)
      if (!has_places(file, array)) return fmt::format("its {} is not that of this run", array.name);
    for (const Profile& array : records.rows)
      if (!has_rows(file, array)) return fmt::format("its array {} has another shape", array.name);
    return {};
  } catch (const InputError&) {
    return "it is damaged";
  }
}

}  // namespace

void drop_parts_after(const fs::path& folder, std::int64_t step) {
  std::vector<fs::path> dropped;
  for (const fs::path& path : entries_of(folder)) {
    const std::string name = path.filename().string();
    const auto part = step_of_part(name.substr(0, name.find(".partial")));
    if (part && (*part > step || is_left_by_a_kill(path))) dropped.push_back(path);
  }
  for (const fs::path& path : dropped) remove_entry(path);
}

RecordParts::RecordParts(MPI_Comm communicator, fs::path folder, std::optional<std::int64_t> continue_from)
    : communicator_(communicator), folder_(std::move(folder)), continue_from_(continue_from) {}

RecordParts::~RecordParts() {
  try {
    if (has_kept()) write_part(kept_until_);
  } catch (const std::exception&) {  // the error that ended the run is the one to tell
  }
}

fs::path RecordParts::part(std::int64_t step) const {
  return folder_ / fmt::format("{}{:09d}{}", before_step, step, after_step);
}

void RecordParts::check(const Records& records) const {
  on_first_rank(communicator_, [&] {
    const fs::path last = continue_from_ ? last_part(folder_, *continue_from_) : fs::path();
    if (last.empty()) return;
    if (const std::string why = mismatch(last, records); !why.empty())
      throw InputError(
          fmt::format("{}: the records cannot be continued, {}; move the folder {} away or restart into another one "
                      "with --out.",
                      last.string(), why, folder_.filename().string()));
  });
}

void RecordParts::begin(const Records& records, std::int64_t step) {
  on_first_rank(communicator_, [&] {
    keep(records);
    drop_parts_after(folder_, continue_from_.value_or(-1));
    if (!continue_from_ || last_part(folder_, *continue_from_).empty()) write_part(step);
  });
}

void RecordParts::add(const Records& records, std::int64_t step) {
  on_first_rank(communicator_, [&] {
    keep(records);
    kept_until_ = step;
    if (kept_bytes_ > most_kept_bytes) write_part(step);
  });
}

void RecordParts::write(std::int64_t step) {
  on_first_rank(communicator_, [&] {
    if (has_kept()) write_part(step);
  });
}

void RecordParts::keep(const Records& records) {
  kept_.fixed = records.fixed;
  kept_.places = records.places;
  if (kept_.rows.empty()) {
    kept_.rows = records.rows;
  } else {
    for (std::size_t n = 0; n < records.rows.size(); ++n) {
      Profile& array = kept_.rows[n];
      array.shape[0] += records.rows[n].shape[0];
      array.values.insert(array.values.end(), records.rows[n].values.begin(), records.rows[n].values.end());
    }
  }
  kept_.events.insert(kept_.events.end(), records.events.begin(), records.events.end());
  kept_bytes_ += bytes_of(records);
}

void RecordParts::write_part(std::int64_t step) {
  make_folder(folder_);
  Hdf5Writer file(MPI_COMM_SELF, part(step));
  ArrayLabeller arrays(file);
  for (const WholeNumbers& numbers : kept_.fixed) arrays.write("", numbers);
  for (const Profile& array : kept_.places) arrays.write("", array);
  for (const Profile& array : kept_.rows) arrays.write("", array);
  for (const Event& event : kept_.events) io::write(file, arrays, event);
  arrays.name_dimensions();
  file.close();
  kept_.rows.clear();
  kept_.events.clear();
  kept_bytes_ = 0;
}

}  // namespace thalweg::io
