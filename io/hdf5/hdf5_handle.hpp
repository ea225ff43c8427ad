// Shared by io's HDF5 sources: owned identifiers, the parallel access, silence. Included by their .cpp files only.
#pragma once

#include <hdf5.h>
#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

namespace thalweg::io {

// An HDF5 identifier that closes itself. A negative one stands for a call that failed.
class Handle {
public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  bool good() const { return id_ >= 0; }
  operator hid_t() const { return id_; }
  hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }
  void reset() {
    if (good()) close_(id_);
    id_ = H5I_INVALID_HID;
  }

private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

// HDF5 prints its own stack of errors unless told not to; ours say it in one sentence.
inline void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// Access to a file through MPI-IO by all ranks of a communicator, also where there is only one, so that the layout of
// the file is always the same. What a process that was killed while it opened this file has left behind is taken away.
// Collective.
Handle mpi_access(MPI_Comm communicator, const std::filesystem::path& file);

// Access by this process alone, without MPI, to a file that is not being written.
Handle lone_access();

// Rows, columns, ... of a dataset; none if it cannot be asked.
std::vector<hsize_t> extents_of(hid_t dataset);

// True if the file has room for as many values as the dataset claims. Its dimensions are only numbers, which may be
// anything in a damaged file and must not be allocated unchecked.
bool has_its_values(hid_t dataset);

}  // namespace thalweg::io
