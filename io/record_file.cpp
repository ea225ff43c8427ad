#include "io/record_file.hpp"

#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "core/on_first_rank.hpp"
#include "io/atomic_file.hpp"
#include "io/hdf5_handle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

namespace thalweg::io {
namespace {

// What went wrong on rank 0, for all to throw.
struct CannotWrite {};
struct Damaged {};   // a file of which nothing can be made
struct CannotGoOn {  // a good file, of a run that records something else
  std::string why;
};

hid_t must(hid_t id) {
  if (id < 0) throw CannotWrite{};
  return id;
}

Handle plain(hid_t property_class) {
  Handle properties(must(H5Pcreate(property_class)), H5Pclose);
  H5Pset_obj_track_times(properties, false);  // equal runs write equal files
  return properties;
}

void write_attribute(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(must(H5Acreate2(object, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT)), H5Aclose);
  must(H5Awrite(attribute, memory_type, value));
}

void write_text(hid_t object, const std::string& name, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  write_attribute(object, name, type, type, value.c_str());
}

void write_number(hid_t object, const std::string& name, double value) {
  write_attribute(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

// What was written goes to the file now, where it shows whether there is room: closing would not say.
void flush(hid_t dataset) { must(H5Dflush(dataset)); }

void describe(hid_t dataset, const Profile& array) {
  write_text(dataset, "unit", array.unit);
  if (!array.components.empty()) write_text(dataset, "components", fmt::format("{}", fmt::join(array.components, " ")));
}

void write_numbers(hid_t parent, const WholeNumbers& numbers) {
  const hsize_t count = numbers.values.size();
  const Handle space(must(H5Screate_simple(1, &count, nullptr)), H5Sclose), creation = plain(H5P_DATASET_CREATE);
  const Handle dataset(
      must(H5Dcreate2(parent, numbers.name.c_str(), H5T_STD_I64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT)),
      H5Dclose);
  if (count > 0) must(H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.values.data()));
  write_text(dataset, "unit", "1");
  flush(dataset);
}

void write_array(hid_t parent, const Profile& array) {
  const std::vector<hsize_t> shape(array.shape.begin(), array.shape.end());
  const Handle space(must(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr)), H5Sclose);
  const Handle creation = plain(H5P_DATASET_CREATE);
  const Handle dataset(
      must(H5Dcreate2(parent, array.name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT)),
      H5Dclose);
  if (!array.values.empty())
    must(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()));
  describe(dataset, array);
  flush(dataset);
}

// The name with the next number at its end: event_000009, event_000010.
std::string next_name(const std::string& name) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  const long long number = digits < name.size() ? std::stoll(name.substr(digits)) : 0;
  return fmt::format("{}{:0{}}", name.substr(0, digits), number + 1, name.size() - digits);
}

// Under the name of the event, or the next that is free: the file may have events of an earlier part of the run, which
// was watched otherwise.
void write_event(hid_t file, const Event& event) {
  const Handle creation = plain(H5P_GROUP_CREATE);
  std::string name = event.name;
  while (H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0) name = next_name(name);
  const Handle group(must(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT)), H5Gclose);
  write_number(group, "time", event.time);
  write_text(group, "time_unit", "s");
  for (const Figure& figure : event.figures) {
    write_number(group, figure.name, figure.value);
    write_text(group, figure.name + "_unit", figure.unit);
  }
  for (const WholeNumbers& numbers : event.numbers) write_numbers(group, numbers);
  for (const Profile& array : event.arrays) write_array(group, array);
}

// An array without rows that can get longer, in chunks of about 32 KiB.
void create_growing(hid_t file, const Profile& array) {
  std::vector<hsize_t> shape(array.shape.begin(), array.shape.end()), limit = shape, chunk = shape;
  shape[0] = 0;
  limit[0] = H5S_UNLIMITED;
  hsize_t row = 1;
  for (std::size_t d = 1; d < shape.size(); ++d) row *= shape[d];
  chunk[0] = std::max<hsize_t>(1, 4096 / std::max<hsize_t>(1, row));
  const auto dimensions = static_cast<int>(shape.size());
  const Handle space(must(H5Screate_simple(dimensions, shape.data(), limit.data())), H5Sclose);
  const Handle creation = plain(H5P_DATASET_CREATE);
  H5Pset_chunk(creation, dimensions, chunk.data());
  const Handle dataset(
      must(H5Dcreate2(file, array.name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT)), H5Dclose);
  describe(dataset, array);
}

Handle open_array(hid_t file, const std::string& name) {
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0) throw Damaged{};
  return Handle(must(H5Dopen2(file, name.c_str(), H5P_DEFAULT)), H5Dclose);
}

void add_rows(hid_t file, const Profile& array) {
  if (array.shape[0] == 0) return;
  const Handle dataset = open_array(file, array.name);
  std::vector<hsize_t> extents = extents_of(dataset), start(extents.size(), 0);
  const std::vector<hsize_t> count(array.shape.begin(), array.shape.end());
  start[0] = extents[0];
  extents[0] += count[0];
  must(H5Dset_extent(dataset, extents.data()));
  const Handle space(H5Dget_space(dataset), H5Sclose);
  must(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  const Handle memory(must(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr)), H5Sclose);
  must(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, array.values.data()));
  flush(dataset);
}

void check_fixed(hid_t file, const WholeNumbers& numbers) {
  const Handle dataset = open_array(file, numbers.name);
  const std::vector<hsize_t> extents = extents_of(dataset);
  const bool fits = extents.size() == 1 && extents[0] == numbers.values.size();
  std::vector<std::int64_t> found(fits ? extents[0] : 0);
  if (!found.empty()) must(H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, found.data()));
  if (found != numbers.values) throw CannotGoOn{fmt::format("its {} is not that of this run", numbers.name)};
}

// The rows of an array for which the file has room: one that is damaged may claim any number.
hsize_t stored_rows(hid_t dataset) {
  const std::vector<hsize_t> extents = extents_of(dataset);
  if (extents.empty()) throw Damaged{};
  if (extents[0] == 0) return 0;
  hsize_t row = sizeof(double);
  for (std::size_t d = 1; d < extents.size(); ++d) row *= extents[d];
  const hsize_t stored = H5Dget_storage_size(dataset);  // it goes through the whole index of chunks; 0: that is broken
  if (stored == 0 || row == 0) throw Damaged{};
  return std::min(extents[0], stored / row);
}

// The number of rows up to a time, as far as times rise: after a crash there may be rows that were never written.
hsize_t rows_until(hid_t file, double time) {
  const Handle dataset = open_array(file, "time");
  if (extents_of(dataset).size() != 1) throw Damaged{};
  const hsize_t start = 0, count = stored_rows(dataset);
  std::vector<double> times(count);
  if (count > 0) {
    const Handle space(H5Dget_space(dataset), H5Sclose), memory(must(H5Screate_simple(1, &count, nullptr)), H5Sclose);
    must(H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &count, nullptr));
    must(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, times.data()));
  }
  std::size_t rows = 0;
  while (rows < times.size() && times[rows] <= time && (rows == 0 || times[rows] > times[rows - 1])) ++rows;
  return rows;
}

void check_shape(hid_t file, const Profile& array) {
  const std::vector<hsize_t> extents = extents_of(open_array(file, array.name)),
                             wanted(array.shape.begin(), array.shape.end());
  if (extents.size() != wanted.size() || !std::equal(extents.begin() + 1, extents.end(), wanted.begin() + 1))
    throw CannotGoOn{fmt::format("its array {} has another shape", array.name)};
}

void drop_rows_after(hid_t file, const std::vector<Profile>& rows, double time) {
  if (rows.empty()) return;
  hsize_t kept = rows_until(file, time);
  for (const Profile& array : rows)  // all have as many, unless the last addition was cut off
    kept = std::min(kept, stored_rows(open_array(file, array.name)));
  for (const Profile& array : rows) {
    const Handle dataset = open_array(file, array.name);
    std::vector<hsize_t> extents = extents_of(dataset);
    extents[0] = kept;
    must(H5Dset_extent(dataset, extents.data()));
  }
}

void drop_events_after(hid_t file, double time) {
  std::vector<std::string> groups;
  const auto collect = [](hid_t parent, const char* name, const H5L_info_t*, void* into) -> herr_t {
    if (H5Aexists_by_name(parent, name, "time", H5P_DEFAULT) > 0)
      static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  hsize_t index = 0;
  must(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, &index, collect, &groups));
  for (const std::string& name : groups) {
    double at = 0.0;
    {
      const Handle attribute(must(H5Aopen_by_name(file, name.c_str(), "time", H5P_DEFAULT, H5P_DEFAULT)), H5Aclose);
      must(H5Aread(attribute, H5T_NATIVE_DOUBLE, &at));
    }
    if (at > time) must(H5Ldelete(file, name.c_str(), H5P_DEFAULT));
  }
}

Handle access_to_add() {
  Handle access = lone_access();
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);  // the earliest format with checksums of metadata
  return access;
}

// Also while somebody reads it.
Handle open_file(const std::filesystem::path& path, unsigned access = H5F_ACC_RDWR) {
  return Handle(H5Fopen(path.c_str(), access, access_to_add()), H5Fclose);
}

void check_file(const std::filesystem::path& path, const Records& records) {
  const Handle file = open_file(path, H5F_ACC_RDONLY);
  if (!file.good()) throw Damaged{};
  try {
    for (const WholeNumbers& numbers : records.fixed) check_fixed(file, numbers);
    for (const Profile& array : records.rows) check_shape(file, array);
  } catch (const CannotWrite&) {
    throw Damaged{};
  }
}

void take_up(const std::filesystem::path& path, const Records& records, double from) {
  check_file(path, records);
  const Handle file = open_file(path);
  if (!file.good()) throw Damaged{};
  try {
    drop_rows_after(file, records.rows, from);
    drop_events_after(file, from);
  } catch (const CannotWrite&) {
    throw Damaged{};
  }
}

void create(const std::filesystem::path& path, const Records& records) {
  const Handle file(must(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, plain(H5P_FILE_CREATE), access_to_add())), H5Fclose);
  for (const WholeNumbers& numbers : records.fixed) write_numbers(file, numbers);
  for (const Profile& array : records.rows) create_growing(file, array);
}

// Moves a file to the first free name of tracks.damaged_1.h5, tracks.damaged_2.h5, ... and returns that.
std::filesystem::path set_aside(const std::filesystem::path& path) {
  std::filesystem::path aside;
  std::error_code error;
  for (int number = 1; aside.empty() || std::filesystem::exists(aside, error); ++number)
    aside = path.parent_path() /
            fmt::format("{}{}{}{}", path.stem().string(), RecordFile::damaged_mark, number, path.extension().string());
  std::filesystem::rename(path, aside, error);
  if (error) throw CannotWrite{};
  return aside;
}

std::string cannot_write_text(const std::filesystem::path& path) {
  return fmt::format("{}: cannot write the file; is the disk full or the folder write-protected?", path.string());
}

}  // namespace

RecordFile::RecordFile(MPI_Comm communicator, std::filesystem::path path, std::optional<double> continue_from)
    : communicator_(communicator), path_(std::move(path)), continue_from_(continue_from) {
  silence_hdf5();
}

void RecordFile::open_or_create(const Records& records) {
  opened_ = true;
  std::error_code ignored;
  if (continue_from_ && std::filesystem::exists(path_, ignored)) {
    try {
      return take_up(path_, records, *continue_from_);
    } catch (const Damaged&) {
      warning_ = fmt::format(
          "{} is damaged, as by a kill while it was being written, and cannot be continued: it is kept as {}, and a "
          "new "
          "file begins at {:.6g} s",
          path_.string(), set_aside(path_).filename().string(), *continue_from_);
    }
  }
  create(path_, records);
}

void RecordFile::write(const Records& records) {
  if (!opened_) open_or_create(records);
  const bool no_rows = records.rows.empty() || records.rows[0].shape[0] == 0;
  if (no_rows && records.events.empty()) return;
  Handle file = open_file(path_);
  must(file);
  for (const Profile& array : records.rows) add_rows(file, array);
  for (const Event& event : records.events) write_event(file, event);
  must(H5Fflush(file, H5F_SCOPE_LOCAL));
  must(H5Fclose(file.release()));
}

void RecordFile::put_on_disk() {
  const bool failed = rank_of(communicator_) == 0 && opened_ && !io::put_on_disk(path_);
  if (any_rank(communicator_, failed)) throw RunError(cannot_write_text(path_));
}

void RecordFile::check(const Records& records) const {
  act([&] {
    std::error_code ignored;
    if (!continue_from_ || !std::filesystem::exists(path_, ignored)) return;
    try {
      check_file(path_, records);
    } catch (const Damaged&) {  // add() sets it aside
    }
  });
}

void RecordFile::add(const Records& records) {
  act([&] { write(records); });
}

void RecordFile::act(const std::function<void()>& work) const {
  on_first_rank(communicator_, [&] {
    try {
      work();
    } catch (const CannotWrite&) {
      throw RunError(cannot_write_text(path_));
    } catch (const CannotGoOn& reason) {
      throw InputError(
          fmt::format("{}: the file cannot be continued, {}; move it away or restart into another folder with "
                      "--out.",
                      path_.string(), reason.why));
    }
  });
}

}  // namespace thalweg::io
