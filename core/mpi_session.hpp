// MPI for the life of the program, and a few collective helpers.
#pragma once

#include <mpi.h>

#include <cstdint>
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

double sum_over_ranks(MPI_Comm communicator, double value);  // order of ranks: for timings, not for results
std::int64_t sum_over_ranks(MPI_Comm communicator, std::int64_t value);
double max_over_ranks(MPI_Comm communicator, double value);
bool any_rank(MPI_Comm communicator, bool value);

// Sends rows[i] to rank destination[i]; returns what the others sent here, ordered by sending rank, then by the
// sender's order. Row must be trivially copyable. Collective.
template <typename Row>
std::vector<Row> exchange_rows(MPI_Comm communicator, const std::vector<Row>& rows,
                               const std::vector<int>& destination);

}  // namespace thalweg

#include "core/mpi_session.ipp"
