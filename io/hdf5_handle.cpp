#include "io/hdf5_handle.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace thalweg::io {

Handle mpi_access(MPI_Comm communicator) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL);
  H5Pset_all_coll_metadata_ops(access, false);
  H5Pset_coll_metadata_write(access, true);
  return access;
}

bool can_create(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) return false;
  ::close(file);
  return std::remove(path.c_str()) == 0;
}

bool put_on_disk(const std::filesystem::path& from, const std::filesystem::path& to) {
  const int file = ::open(from.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = ::fsync(file) == 0;
  ::close(file);
  return synced && std::rename(from.c_str(), to.c_str()) == 0;
}

}  // namespace thalweg::io
