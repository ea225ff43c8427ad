#include "core/base/error.hpp"
#include "core/base/utf8.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/files/atomic_file.hpp"
#include "io/hdf5/checksum.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/hdf5_dataset.hpp"
#include "io/hdf5/scale_attributes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace thalweg::io {
namespace {

// The tables of the file (metadata) stay in memory until there is room for all of them, see close().
void keep_tables_until_close(hid_t access) {
  H5AC_cache_config_t config;
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  if (H5Pget_mdc_config(access, &config) < 0) return;
  config.dirty_bytes_threshold = 8 << 20;  // bytes changed before HDF5 writes them by itself; 256 kB by default
  H5Pset_mdc_config(access, &config);
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
  try {
    file_->agree(file_->file.good());
  } catch (...) {
    give_up();  // no destructor does
    throw;
  }
}

// A file that is given up is never closed: closing is collective, and another rank's exception may be on its way; and
// HDF5 cannot recover from a close that fails, as on a full disk.
Hdf5Writer::~Hdf5Writer() {
  if (file_->file.good()) give_up();
}

void Hdf5Writer::give_up() {
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
  // A fixed length, with the closing zero: variable lengths live in a heap without checksums, and nc_get_att_text()
  // refuses them, by which netCDF tools in C and Fortran read units.
  H5Tset_size(type, text.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  file_->attribute(path, type, type, text.c_str());
}

MPI_Comm Hdf5Writer::communicator() const { return file_->communicator; }

void Hdf5Writer::name_dimensions(const DimensionScales& scales) {
  for (const DimensionScales::Scale& scale : scales.scales) {
    attribute(scale.path + "/CLASS", std::string("DIMENSION_SCALE"));
    attribute(scale.path + "/NAME", name_of_scale(scale));
  }
  file_->tables += bytes_of_attributes(scales);
  file_->agree(write_scale_attributes(file_->file, scales));
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

}  // namespace thalweg::io
