// Repeated exchange of one packed message with each neighbour, by persistent requests. The halo exchange of the lattice
// and the ghost refresh of the grains use it.
#pragma once

#include "core/base/check.hpp"

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace thalweg {

class PackedExchange {
public:
  struct Neighbour {
    int rank;
    int send_tag;  // must equal the receive_tag of the matching Neighbour on the other side
    int receive_tag;
    std::size_t send_bytes;
    std::size_t receive_bytes;
  };

  PackedExchange() = default;
  PackedExchange(MPI_Comm communicator, const std::vector<Neighbour>& neighbours);
  ~PackedExchange();
  PackedExchange(PackedExchange&& other) noexcept;
  PackedExchange& operator=(PackedExchange&& other) noexcept;
  PackedExchange(const PackedExchange&) = delete;
  PackedExchange& operator=(const PackedExchange&) = delete;

  std::size_t neighbours() const { return send_.size(); }

  // Fill every send buffer, then start(); the buffers must not be touched until finish() returns.
  template <typename T>
  T* send_buffer(std::size_t n) {
    CHECK(n < send_.size() && !under_way_);
    return reinterpret_cast<T*>(send_[n].data());
  }
  template <typename T>
  const T* receive_buffer(std::size_t n) const {
    CHECK(n < receive_.size() && !under_way_);
    return reinterpret_cast<const T*>(receive_[n].data());
  }
  void start();
  void finish();
  bool under_way() const { return under_way_; }

private:
  void release();

  std::vector<std::vector<std::byte>> send_, receive_;
  std::vector<MPI_Request> requests_;
  bool under_way_ = false;
};

}  // namespace thalweg
