// Template bodies of mpi_session.hpp.
#pragma once

namespace thalweg {

template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, const std::vector<Row>& rows,
                               const std::vector<int>& destination) {
  static_assert(std::is_trivially_copyable_v<Row>);
  const int ranks = size_of(communicator);
  MPI_Datatype row_type;
  MPI_Type_contiguous(sizeof(Row), MPI_BYTE, &row_type);
  MPI_Type_commit(&row_type);

  std::vector<int> send_counts(ranks, 0), receive_counts(ranks, 0);
  for (int to : destination) ++send_counts[to];
  MPI_Alltoall(send_counts.data(), 1, MPI_INT, receive_counts.data(), 1, MPI_INT, communicator);

  std::vector<int> send_start(ranks, 0), receive_start(ranks, 0);
  for (int r = 1; r < ranks; ++r) {
    send_start[r] = send_start[r - 1] + send_counts[r - 1];
    receive_start[r] = receive_start[r - 1] + receive_counts[r - 1];
  }
  std::vector<Row> packed(rows.size());
  std::vector<int> next = send_start;
  for (std::size_t i = 0; i < rows.size(); ++i) packed[next[destination[i]]++] = rows[i];

  std::vector<Row> received(receive_start.back() + receive_counts.back());
  MPI_Alltoallv(packed.data(), send_counts.data(), send_start.data(), row_type, received.data(), receive_counts.data(),
                receive_start.data(), row_type, communicator);
  MPI_Type_free(&row_type);
  return received;
}

}  // namespace thalweg
