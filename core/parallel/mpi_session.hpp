// MPI for the life of the program, and a few collective helpers.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <vector>

namespace thalweg {

// Initialises MPI on construction and finalises it on destruction; also sets the processor to flush denormal numbers to
// zero on every rank (decaying flows produce them, and they cost a factor of a hundred).
class MpiSession {
public:
  MpiSession(int& argc, char**& argv);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
};

// Sets flush-to-zero and denormals-are-zero for the calling thread.
void flush_denormals_to_zero();

int rank_of(MPI_Comm communicator);
int size_of(MPI_Comm communicator);

double sum_over_ranks(MPI_Comm communicator, double value);  // rounding depends on the ranks: not for results
std::int64_t sum_over_ranks(MPI_Comm communicator, std::int64_t value);
double max_over_ranks(MPI_Comm communicator, double value);
bool any_rank(MPI_Comm communicator, bool value);

// Sends rows[i] to rank destination[i]; returns what the others sent here, ordered by sending rank, then by the
// sender's order. Row must be trivially copyable. Collective. Memory and messages depend on the number of ranks that
// exchange something with this one, not on all ranks.
template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, const std::vector<Row>& rows,
                               const std::vector<int>& destination);
// The same, but frees the rows before those of others arrive.
template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, std::vector<Row>&& rows, const std::vector<int>& destination);

namespace detail {

// Rows for one rank.
struct Parcel {
  int rank;
  std::size_t first = 0, count = 0;  // in the rows packed by receiver
};

// One parcel for each rank among the destinations, in order of rank: where it begins, and a count of zero.
std::vector<Parcel> parcels_to(const std::vector<int>& destination);

// The parcel for a rank; there must be one.
Parcel& parcel_to(int rank, std::vector<Parcel>& parcels);

// Sends the parcels of the rows at `packed`; writes all that arrives, in the order of the senders' ranks, to
// place(count) with the number of rows. row_size: bytes. Collective. Receivers need not know their senders beforehand:
// T. Hoefler, C. Siebert, A. Lumsdaine, Scalable communication protocols for dynamic sparse data exchange, PPoPP 2010.
void exchange_parcels(MPI_Comm communicator, const std::vector<Parcel>& parcels, const void* packed,
                      std::size_t row_size, const std::function<void*(std::size_t)>& place);

}  // namespace detail

}  // namespace thalweg

#include "core/parallel/mpi_session.ipp"
