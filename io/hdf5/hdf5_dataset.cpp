#include "io/hdf5/hdf5_dataset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <numeric>
#include <stdexcept>

namespace thalweg::io {
namespace {

// Files that are given up stay open. HDF5 would close them at the end of the program, or when MPI ends if it began
// after MPI.
[[maybe_unused]] const bool leaves_files_open = [] {
  H5dont_atexit();
  return H5open() >= 0;
}();

}  // namespace

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

Selection::Selection(const ArrayBox& box)
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

Handle collective_transfer() {
  Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(properties, H5FD_MPIO_COLLECTIVE);
  return properties;
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

}  // namespace thalweg::io
