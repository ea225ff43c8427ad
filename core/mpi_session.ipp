// Template bodies of mpi_session.hpp.
#pragma once

namespace thalweg {

template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, const std::vector<Row>& rows,
                               const std::vector<int>& destination) {
  static_assert(std::is_trivially_copyable_v<Row>);
  std::vector<detail::Parcel> parcels = detail::parcels_to(destination);
  std::vector<Row> packed(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    detail::Parcel& parcel = detail::parcel_to(destination[i], parcels);
    packed[parcel.first + parcel.count++] = rows[i];
  }
  std::vector<Row> received;
  detail::exchange_parcels(communicator, parcels, packed.data(), sizeof(Row), [&](std::size_t count) {
    received.resize(count);
    return received.data();
  });
  return received;
}

}  // namespace thalweg
