#include "io/hdf5/hdf5_handle.hpp"

#include "io/files/shared_file.hpp"

#include <algorithm>

namespace thalweg::io {

Handle mpi_access(MPI_Comm communicator, const std::filesystem::path& file) {
  forget_semaphore_of(communicator, file);
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL);
  return access;
}

Handle lone_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, false, true);  // as through MPI-IO; not every parallel file system has locks
#endif
  return access;
}

std::vector<hsize_t> extents_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<hsize_t> extents(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (!extents.empty()) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  return extents;
}

bool has_its_values(hid_t dataset) {
  constexpr double most_compressed = 1032.0;  // what deflate makes of zeros
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose), type(H5Dget_type(dataset), H5Tclose);
  auto bytes = static_cast<double>(H5Tget_size(type));
  for (const hsize_t extent : extents_of(dataset)) bytes *= static_cast<double>(extent);
  const double stored = static_cast<double>(H5Dget_storage_size(dataset));
  return bytes <= stored * (H5Pget_nfilters(creation) > 0 ? most_compressed : 1.0);
}

}  // namespace thalweg::io
