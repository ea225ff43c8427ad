// Template bodies of mpi_session.hpp.
#pragma once

#include "core/base/check.hpp"

namespace thalweg {

namespace detail {

template <typename Row>
struct Packed {
  std::vector<Row> rows;  // by receiver
  std::vector<Parcel> parcels;
};

template <typename Row>
Packed<Row> packed(const std::vector<Row>& rows, const std::vector<int>& destination) {
  CHECK(destination.size() == rows.size());
  Packed<Row> result{std::vector<Row>(rows.size()), parcels_to(destination)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Parcel& parcel = parcel_to(destination[i], result.parcels);
    result.rows[parcel.first + parcel.count++] = rows[i];
  }
  return result;
}

template <typename Row>
std::vector<Row> exchanged(MPI_Comm communicator, const Packed<Row>& sent) {
  static_assert(std::is_trivially_copyable_v<Row>);
  std::vector<Row> received;
  exchange_parcels(communicator, sent.parcels, sent.rows.data(), sizeof(Row), [&](std::size_t count) {
    received.resize(count);
    return received.data();
  });
  return received;
}

}  // namespace detail

template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, const std::vector<Row>& rows,
                               const std::vector<int>& destination) {
  return detail::exchanged(communicator, detail::packed(rows, destination));
}

template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, std::vector<Row>&& rows, const std::vector<int>& destination) {
  CHECK(destination.size() == rows.size());
  if (size_of(communicator) == 1) return std::move(rows);
  const detail::Packed<Row> sent = detail::packed(rows, destination);
  std::vector<Row>().swap(rows);
  return detail::exchanged(communicator, sent);
}

}  // namespace thalweg
