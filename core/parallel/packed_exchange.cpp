#include "core/parallel/packed_exchange.hpp"

#include "core/base/check.hpp"
#include "core/parallel/mpi_count.hpp"

#include <utility>

namespace thalweg {

PackedExchange::PackedExchange(MPI_Comm communicator, const std::vector<Neighbour>& neighbours)
    : send_(neighbours.size()), receive_(neighbours.size()), requests_(2 * neighbours.size(), MPI_REQUEST_NULL) {
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    const Neighbour& to = neighbours[n];
    send_[n].resize(to.send_bytes);
    receive_[n].resize(to.receive_bytes);
    MPI_Recv_init(receive_[n].data(), mpi_count(to.receive_bytes), MPI_BYTE, to.rank, to.receive_tag, communicator,
                  &requests_[2 * n]);
    MPI_Send_init(send_[n].data(), mpi_count(to.send_bytes), MPI_BYTE, to.rank, to.send_tag, communicator,
                  &requests_[2 * n + 1]);
  }
}

PackedExchange::~PackedExchange() { release(); }

PackedExchange::PackedExchange(PackedExchange&& other) noexcept
    : send_(std::move(other.send_)),
      receive_(std::move(other.receive_)),
      requests_(std::exchange(other.requests_, {})),
      under_way_(std::exchange(other.under_way_, false)) {}

PackedExchange& PackedExchange::operator=(PackedExchange&& other) noexcept {
  if (this == &other) return *this;
  release();
  send_ = std::move(other.send_);
  receive_ = std::move(other.receive_);
  requests_ = std::exchange(other.requests_, {});
  under_way_ = std::exchange(other.under_way_, false);
  return *this;
}

// Messages are under way only where an error unwinds: then the buffers stay, which MPI may still write to.
void PackedExchange::release() {
  if (under_way_) {
    static std::vector<std::vector<std::vector<std::byte>>> abandoned;
    abandoned.push_back(std::move(send_));
    abandoned.push_back(std::move(receive_));
  }
  for (MPI_Request& request : requests_) MPI_Request_free(&request);
  requests_.clear();
}

void PackedExchange::start() {
  CHECK(!under_way_);
  if (!requests_.empty()) MPI_Startall(static_cast<int>(requests_.size()), requests_.data());
  under_way_ = true;
}

void PackedExchange::finish() {
  CHECK(under_way_);
  if (!requests_.empty()) MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  under_way_ = false;
}

}  // namespace thalweg
