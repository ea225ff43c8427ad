#include "io/hdf5/hdf5_archive.hpp"

#include "core/base/error.hpp"
#include "core/base/utf8.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/files/atomic_file.hpp"
#include "io/hdf5/checksum.hpp"
#include "io/hdf5/hdf5_handle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <functional>
#include <numeric>

namespace thalweg::io {
namespace {

// Files that are given up stay open. HDF5 would close them at the end of the program, or when MPI ends if it began
// after MPI.
[[maybe_unused]] const bool leaves_files_open = [] {
  H5dont_atexit();
  return H5open() >= 0;
}();

// In the file every number is little-endian and of fixed size; in memory it is what this machine uses.
template <typename Number>
struct Stored;
template <>
struct Stored<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static constexpr const char* name = "float64";
};
template <>
struct Stored<float> {
  static hid_t file() { return H5T_IEEE_F32LE; }
  static hid_t memory() { return H5T_NATIVE_FLOAT; }
  static constexpr const char* name = "float32";
};
template <>
struct Stored<std::int64_t> {
  static hid_t file() { return H5T_STD_I64LE; }
  static hid_t memory() { return H5T_NATIVE_INT64; }
  static constexpr const char* name = "int64";
};

std::string name_of_type(hid_t type) {
  if (H5Tequal(type, H5T_IEEE_F64LE) > 0) return Stored<double>::name;
  if (H5Tequal(type, H5T_IEEE_F32LE) > 0) return Stored<float>::name;
  if (H5Tequal(type, H5T_STD_I64LE) > 0) return Stored<std::int64_t>::name;
  return "another type";
}

std::string shown(const std::vector<std::uint64_t>& shape) { return fmt::format("{}", fmt::join(shape, " x ")); }

std::uint64_t volume(const std::vector<std::uint64_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

// The rank's box in the dataset, and the same number of values in a row in memory. A rank with nothing takes part in
// the collective call with empty selections.
struct Selection {
  Handle file, memory;

  explicit Selection(const ArrayBox& box)
      : file(H5Screate_simple(static_cast<int>(box.global_shape.size()),
                              std::vector<hsize_t>(box.global_shape.begin(), box.global_shape.end()).data(), nullptr),
             H5Sclose) {
    const hsize_t count = volume(box.shape);
    memory = Handle(H5Screate_simple(1, &count, nullptr), H5Sclose);
    if (count == 0) {
      H5Sselect_none(file);
      H5Sselect_none(memory);
      return;
    }
    const std::vector<hsize_t> offset(box.offset.begin(), box.offset.end());
    const std::vector<hsize_t> shape(box.shape.begin(), box.shape.end());
    H5Sselect_hyperslab(file, H5S_SELECT_SET, offset.data(), nullptr, shape.data(), nullptr);
  }
};

constexpr const char* checksum_name = "checksum";

Handle collective_transfer() {
  Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(properties, H5FD_MPIO_COLLECTIVE);
  return properties;
}

// The tables of the file (metadata) stay in memory until there is room for all of them, see close().
void keep_tables_until_close(hid_t access) {
  H5AC_cache_config_t config;
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  if (H5Pget_mdc_config(access, &config) < 0) return;
  config.dirty_bytes_threshold = 8 << 20;  // bytes changed before HDF5 writes them by itself; 256 kB by default
  H5Pset_mdc_config(access, &config);
}

void check_box(const std::string& path, const ArrayBox& box, std::size_t values) {
  const std::size_t rank = box.global_shape.size();
  if (rank < 1 || rank > 4 || box.offset.size() != rank || box.shape.size() != rank || volume(box.shape) != values)
    throw std::logic_error(fmt::format("archive path {}: box {} at {} of {} does not describe {} values", path,
                                       shown(box.shape), shown(box.offset), shown(box.global_shape), values));
}

std::pair<std::string, std::string> group_and_name(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {"/", path};
  return {path.substr(0, slash), path.substr(slash + 1)};
}

}  // namespace

struct Hdf5Writer::File {
  MPI_Comm communicator;
  std::filesystem::path path, partial;
  Handle file;
  std::uint64_t data_end = 0;   // bytes: end of the last dataset so far
  std::uint64_t tables = 2048;  // bytes: more than the superblock, headers, names and attributes so far

  // Every rank learns whether all went well.
  void agree(bool good) {
    if (any_rank(communicator, !good))
      throw RunError(fmt::format(
          "{}: cannot write the file; is the disk full or the folder missing or write-protected?", path.string()));
  }

  // Opens a group, or a dataset whose attributes are meant, creating groups where they are missing.
  Handle group(const std::string& name) {
    if (name == "/") return Handle(H5Oopen(file, "/", H5P_DEFAULT), H5Oclose);
    const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    Handle current;
    for (std::size_t end = 0; end != std::string::npos;) {
      end = name.find('/', end + 1);
      const std::string part = name.substr(0, end);
      const bool exists = H5Lexists(file, part.c_str(), H5P_DEFAULT) > 0;
      if (!exists) tables += 1536;
      current = exists ? Handle(H5Oopen(file, part.c_str(), H5P_DEFAULT), H5Oclose)
                       : Handle(H5Gcreate2(file, part.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
    }
    return current;
  }

  template <typename Number>
  void write(const std::string& name, std::span<const Number> values, const ArrayBox& box) {
    check_box(name, box, values.size());
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    H5Pset_layout(creation, H5D_CONTIGUOUS);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);  // every value is written anyway
    const auto [group_name, leaf] = group_and_name(name);
    const Handle parent = group(group_name);
    const Selection selection(box);
    const Handle dataset(
        H5Dcreate2(parent, leaf.c_str(), Stored<Number>::file(), selection.file, H5P_DEFAULT, creation, H5P_DEFAULT),
        H5Dclose);
    agree(dataset.good());
    tables += 384;
    const std::uint64_t bytes = volume(box.global_shape) * sizeof(Number);
    if (bytes == 0) return;  // it has no place in the file that could be written
    std::uint64_t sum = checksum(values, box);
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, communicator);
    const auto stored = std::bit_cast<std::int64_t>(sum);
    attribute(name + "/" + checksum_name, Stored<std::int64_t>::file(), Stored<std::int64_t>::memory(), &stored);
    const std::uint64_t offset = H5Dget_offset(dataset);
    data_end = std::max(data_end, offset + bytes);
    agree(rank_of(communicator) != 0 || reserve_on_disk(partial, offset, bytes));
    const Handle transfer = collective_transfer();
    agree(H5Dwrite(dataset, Stored<Number>::memory(), selection.memory, selection.file, transfer, values.data()) >= 0);
  }

  void attribute(const std::string& name, hid_t file_type, hid_t memory_type, const void* value) {
    const auto [group_name, leaf] = group_and_name(name);
    const Handle parent = group(group_name);
    tables += 128 + H5Tget_size(file_type);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(parent, leaf.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    agree(attribute.good() && H5Awrite(attribute, memory_type, value) >= 0);
  }
};

Hdf5Writer::Hdf5Writer(MPI_Comm communicator, const std::filesystem::path& path) : file_(std::make_unique<File>()) {
  silence_hdf5();
  file_->communicator = communicator;
  file_->path = path;
  file_->partial = path;
  file_->partial += ".partial";
  // MPI-IO keeps the length of a file it finds, so an old one must go first; and rank 0 alone finds out whether the
  // folder can be written at all, because a failed collective open is not always collective.
  bool creatable = true;
  if (rank_of(communicator) == 0) {
    std::error_code ignored;
    std::filesystem::remove(file_->partial, ignored);
    creatable = can_create(file_->partial);
  }
  file_->agree(creatable);
  const Handle access = mpi_access(communicator, file_->partial);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);  // the earliest format with checksums of metadata
  keep_tables_until_close(access);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  file_->file = Handle(H5Fcreate(file_->partial.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
  file_->agree(file_->file.good());
}

// A file that is given up is never closed: closing is collective, and another rank's exception may be on its way; and
// HDF5 cannot recover from a close that fails, as on a full disk.
Hdf5Writer::~Hdf5Writer() {
  if (!file_->file.good()) return;
  file_->file.release();
  if (rank_of(file_->communicator) != 0) return;
  std::error_code ignored;
  std::filesystem::resize_file(file_->partial, 0, ignored);  // gives back the room, which an open file would keep
  std::filesystem::remove(file_->partial, ignored);
}

void Hdf5Writer::write(const std::string& path, std::span<const double> values, const ArrayBox& box) {
  file_->write(path, values, box);
}
void Hdf5Writer::write(const std::string& path, std::span<const float> values, const ArrayBox& box) {
  file_->write(path, values, box);
}
void Hdf5Writer::write(const std::string& path, std::span<const std::int64_t> values, const ArrayBox& box) {
  file_->write(path, values, box);
}
void Hdf5Writer::attribute(const std::string& path, double value) {
  file_->attribute(path, Stored<double>::file(), Stored<double>::memory(), &value);
}
void Hdf5Writer::attribute(const std::string& path, std::int64_t value) {
  file_->attribute(path, Stored<std::int64_t>::file(), Stored<std::int64_t>::memory(), &value);
}
void Hdf5Writer::attribute(const std::string& path, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  const std::string text = as_utf8(value);
  H5Tset_size(type, text.size() + 1);  // a fixed length, with the closing zero: variable lengths live in a heap
  H5Tset_cset(type, H5T_CSET_UTF8);
  file_->attribute(path, type, type, text.c_str());
}

void Hdf5Writer::close() {
  // The tables that are still to be written need room first: where writing them fails on one rank only, the ranks can
  // no longer close the file together. HDF5 gives back what is too much.
  file_->agree(rank_of(file_->communicator) != 0 ||
               reserve_on_disk(file_->partial, 0, file_->data_end + file_->tables, file_->data_end));
  file_->agree(H5Fflush(file_->file, H5F_SCOPE_GLOBAL) >= 0);
  file_->agree(H5Fclose(file_->file.release()) >= 0);
  bool renamed = true;
  if (rank_of(file_->communicator) == 0) renamed = put_on_disk(file_->partial, file_->path);
  file_->agree(renamed);
}

struct Hdf5Reader::File {
  MPI_Comm communicator;  // MPI_COMM_NULL: this process alone, perhaps without MPI
  std::filesystem::path path;
  Handle file;
  bool needs_checksums = false;

  bool alone() const { return communicator == MPI_COMM_NULL; }
  bool any(bool mine) const { return alone() ? mine : any_rank(communicator, mine); }

  void open() {
    silence_hdf5();
    enum Outcome : int { well, missing, not_hdf5 };
    int outcome = well;  // rank 0 looks before all open together
    if (alone() || rank_of(communicator) == 0) {
      std::error_code ignored;
      if (!std::filesystem::exists(path, ignored))
        outcome = missing;
      else if (H5Fis_hdf5(path.c_str()) <= 0)
        outcome = not_hdf5;
    }
    if (!alone()) MPI_Bcast(&outcome, 1, MPI_INT, 0, communicator);
    if (outcome == missing) throw InputError(fmt::format("{}: there is no such file; check the path.", path.string()));
    const Handle access = alone() ? lone_access() : mpi_access(communicator, path);
    if (outcome == well) file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
    if (any(!file.good()))
      throw DamagedFile(fmt::format("{}: this is not an HDF5 file or it is damaged; give one that a run has written.",
                                    path.string()));
  }

  InputError error(const std::string& name, const std::string& what) const {
    return InputError(fmt::format("{}: {}: {}; was the file written by this program for a case like this one?",
                                  path.string(), name, what));
  }

  // H5Lexists wants every group on the way to exist.
  bool has_link(const std::string& name) const {
    for (std::size_t end = 0; end != std::string::npos;) {
      end = name.find('/', end + 1);
      const htri_t exists = H5Lexists(file, name.substr(0, end).c_str(), H5P_DEFAULT);
      if (exists < 0) throw damaged(name, "the table of contents cannot be read");
      if (exists == 0) return false;
    }
    return true;
  }

  bool has_attribute(const std::string& name) const {
    const auto [group_name, leaf] = group_and_name(name);
    if (group_name != "/" && !has_link(group_name)) return false;
    const htri_t exists = H5Aexists_by_name(file, group_name.c_str(), leaf.c_str(), H5P_DEFAULT);
    if (exists < 0) throw damaged(name, "the attributes cannot be read");
    return exists > 0;
  }

  Handle dataset(const std::string& name) const {
    if (!has_link(name)) throw error(name, "the file has no such data");
    Handle found(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!found.good()) throw damaged(name, "the description of the data cannot be read");
    return found;
  }

  std::vector<std::uint64_t> shape(const std::string& name) const {
    const Handle found = dataset(name);
    const std::vector<hsize_t> extents = extents_of(found);
    if (extents.empty()) throw error(name, "the file holds a single value, and rows of values are needed");
    if (!has_its_values(found))
      throw damaged(name, fmt::format("the file announces {} values and does not hold so many",
                                      shown({extents.begin(), extents.end()})));
    return {extents.begin(), extents.end()};
  }

  template <typename Number>
  void read(const std::string& name, std::span<Number> values, const ArrayBox& box) const {
    check_box(name, box, values.size());
    const Handle found = dataset(name);
    const Handle type(H5Dget_type(found), H5Tclose);
    if (H5Tequal(type, Stored<Number>::file()) <= 0)
      throw error(name, fmt::format("the file holds {}, but {} is needed", name_of_type(type), Stored<Number>::name));
    const std::vector<hsize_t> extents = extents_of(found);
    const std::vector<std::uint64_t> stored(extents.begin(), extents.end());
    if (stored != box.global_shape)
      throw error(name, fmt::format("the file holds {} values, but {} are needed", stored.empty() ? "1" : shown(stored),
                                    shown(box.global_shape)));
    if (volume(stored) == 0) return;
    const Selection selection(box);
    const Handle transfer = alone() ? Handle(H5Pcreate(H5P_DATASET_XFER), H5Pclose) : collective_transfer();
    const bool good =
        H5Dread(found, Stored<Number>::memory(), selection.memory, selection.file, transfer, values.data()) >= 0;
    if (any(!good)) throw damaged(name, "the data cannot be read");
    if (has_attribute(name + "/" + checksum_name))
      verify(name, checksum(std::span<const Number>(values), box), box);
    else if (needs_checksums)
      throw damaged(name, "the data have no checksum");
  }

  // mine: the checksum of what this rank has read.
  void verify(const std::string& name, std::uint64_t mine, const ArrayBox& box) const {
    const std::vector<std::uint64_t> start(box.global_shape.size(), 0);
    enum { sum, covered, whole, ranks, items };
    std::uint64_t all[items] = {mine, coverage(box.offset, box.shape), box.shape == box.global_shape ? 1u : 0u, 1u};
    if (!alone()) MPI_Allreduce(MPI_IN_PLACE, all, items, MPI_UINT64_T, MPI_SUM, communicator);
    const auto stored = std::bit_cast<std::uint64_t>(number_attribute<std::int64_t>(name + "/" + checksum_name));
    const bool each_all = all[whole] == all[ranks];
    const bool shared_out = !each_all && all[covered] == coverage(start, box.global_shape);
    if ((shared_out && all[sum] != stored) || (each_all && any(mine != stored)))
      throw damaged(name, "the data are not those that were written");
  }

  DamagedFile damaged(const std::string& name, const std::string& what) const {
    return DamagedFile(
        fmt::format("{}: {}: {}, the file is damaged; take an earlier checkpoint, or write the file again.",
                    path.string(), name, what));
  }

  Handle attribute(const std::string& name) const {
    if (!has_attribute(name)) throw error(name, "the file has no such attribute");
    const auto [group_name, leaf] = group_and_name(name);
    return Handle(H5Aopen_by_name(file, group_name.c_str(), leaf.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  }

  template <typename Number>
  Number number_attribute(const std::string& name) const {
    const Handle found = attribute(name);
    const Handle type(H5Aget_type(found), H5Tclose);
    Number value{};
    if (H5Tequal(type, Stored<Number>::file()) <= 0 || H5Aread(found, Stored<Number>::memory(), &value) < 0)
      throw error(name, fmt::format("the attribute is not of type {}", Stored<Number>::name));
    return value;
  }
};

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : Hdf5Reader(MPI_COMM_NULL, path) {}

Hdf5Reader::Hdf5Reader(MPI_Comm communicator, const std::filesystem::path& path)
    : file_(std::make_unique<File>(File{communicator, path, {}, false})) {
  file_->open();
}

Hdf5Reader::~Hdf5Reader() {
  // As for the writer: another rank may not come to close the file.
  if (!file_->alone() && std::uncaught_exceptions() > 0) file_->file.release();
}

void Hdf5Reader::require_checksums() { file_->needs_checksums = true; }

bool Hdf5Reader::has(const std::string& path) const { return file_->has_link(path) || file_->has_attribute(path); }

std::vector<std::uint64_t> Hdf5Reader::shape(const std::string& path) const { return file_->shape(path); }

void Hdf5Reader::read(const std::string& path, std::span<double> values, const ArrayBox& box) {
  file_->read(path, values, box);
}
void Hdf5Reader::read(const std::string& path, std::span<float> values, const ArrayBox& box) {
  file_->read(path, values, box);
}
void Hdf5Reader::read(const std::string& path, std::span<std::int64_t> values, const ArrayBox& box) {
  file_->read(path, values, box);
}
double Hdf5Reader::real_attribute(const std::string& path) const { return file_->number_attribute<double>(path); }
std::int64_t Hdf5Reader::integer_attribute(const std::string& path) const {
  return file_->number_attribute<std::int64_t>(path);
}

std::string Hdf5Reader::text_attribute(const std::string& path) const {
  const Handle found = file_->attribute(path);
  const Handle type(H5Aget_type(found), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0)
    throw file_->error(path, "the attribute is not a text of fixed length");
  std::string value(H5Tget_size(type), '\0');
  if (H5Aread(found, type, value.data()) < 0) throw file_->error(path, "the attribute cannot be read");
  value.resize(value.find_last_not_of('\0') + 1);
  return value;
}

std::vector<Hdf5Reader::Entry> Hdf5Reader::datasets() const {
  std::vector<std::string> names;
  const auto note = [](hid_t, const char* name, const auto* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
#if H5_VERSION_GE(1, 12, 0)
  H5Ovisit3(file_->file, H5_INDEX_NAME, H5_ITER_INC, note, &names, H5O_INFO_BASIC);
#else
  H5Ovisit(file_->file, H5_INDEX_NAME, H5_ITER_INC, note, &names);
#endif
  std::vector<Entry> entries;
  for (const std::string& name : names) {
    const Handle dataset = file_->dataset(name);
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const std::vector<hsize_t> extents = extents_of(dataset);
    entries.push_back({name, name_of_type(type), {extents.begin(), extents.end()}});
  }
  return entries;
}

}  // namespace thalweg::io
