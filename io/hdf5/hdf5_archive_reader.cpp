#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"
#include "io/hdf5/checksum.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/hdf5_dataset.hpp"

#include <fmt/format.h>

#include <bit>
#include <exception>

namespace thalweg::io {

struct Hdf5Reader::File {
  MPI_Comm communicator;  // MPI_COMM_NULL: this process alone, perhaps without MPI
  std::filesystem::path path;
  Handle file;
  bool needs_checksums = false;

  bool alone() const { return communicator == MPI_COMM_NULL; }
  bool any(bool mine) const { return alone() ? mine : any_rank(communicator, mine); }

  void open() {
    silence_hdf5();
    int is_hdf5 = 0;  // rank 0 looks before all open together
    const auto look = [&] {
      check_readable(path);
      is_hdf5 = H5Fis_hdf5(path.c_str()) > 0 ? 1 : 0;
    };
    alone() ? look() : on_first_rank(communicator, look);
    if (!alone()) MPI_Bcast(&is_hdf5, 1, MPI_INT, 0, communicator);
    const Handle access = alone() ? lone_access() : mpi_access(communicator, path);
    if (is_hdf5 != 0) file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
    if (!any(!file.good())) return;
    file.release();  // another rank has nothing to close with it
    throw DamagedFile(
        fmt::format("{}: this is not an HDF5 file or it is damaged; give one that a run has written.", path.string()));
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
      throw damaged(
          name, fmt::format("the file announces {} values and holds fewer", shown({extents.begin(), extents.end()})));
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
    Handle found(H5Aopen_by_name(file, group_name.c_str(), leaf.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Handle space(H5Aget_space(found), H5Sclose);  // of several values, which would be read over what is beside
    if (H5Sget_simple_extent_npoints(space) != 1) throw error(name, "the attribute is not a single value");
    return found;
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
  // As in the writer, another rank may not come to close the file.
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
