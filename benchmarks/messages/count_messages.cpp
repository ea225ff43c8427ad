// Counts what a program sends to other ranks: preloaded, it stands in front of the MPI library (its profiling
// interface) and prints a line for each rank at the end. Persistent and plain sends count, collective operations do
// not.
#include <mpi.h>

#include <cstdint>
#include <cstdio>
#include <unordered_map>

namespace {

std::int64_t messages = 0, bytes = 0;

// Bytes that a persistent request sends each time. Requests are pointers or numbers, as the library has it.
std::unordered_map<MPI_Request, std::int64_t>& persistent() {
  static std::unordered_map<MPI_Request, std::int64_t> sizes;
  return sizes;
}

std::int64_t bytes_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<std::int64_t>(count) * size;
}

void sent(std::int64_t size) {
  ++messages;
  bytes += size;
}

}  // namespace

extern "C" {

int MPI_Send_init(const void* buffer, int count, MPI_Datatype type, int rank, int tag, MPI_Comm communicator,
                  MPI_Request* request) {
  const int error = PMPI_Send_init(buffer, count, type, rank, tag, communicator, request);
  persistent()[*request] = bytes_of(count, type);
  return error;
}

int MPI_Request_free(MPI_Request* request) {
  persistent().erase(*request);
  return PMPI_Request_free(request);
}

int MPI_Startall(int count, MPI_Request* requests) {
  for (int n = 0; n < count; ++n)
    if (const auto found = persistent().find(requests[n]); found != persistent().end()) sent(found->second);
  return PMPI_Startall(count, requests);
}

int MPI_Isend(const void* buffer, int count, MPI_Datatype type, int rank, int tag, MPI_Comm communicator,
              MPI_Request* request) {
  sent(bytes_of(count, type));
  return PMPI_Isend(buffer, count, type, rank, tag, communicator, request);
}

int MPI_Issend(const void* buffer, int count, MPI_Datatype type, int rank, int tag, MPI_Comm communicator,
               MPI_Request* request) {
  sent(bytes_of(count, type));
  return PMPI_Issend(buffer, count, type, rank, tag, communicator, request);
}

int MPI_Send(const void* buffer, int count, MPI_Datatype type, int rank, int tag, MPI_Comm communicator) {
  sent(bytes_of(count, type));
  return PMPI_Send(buffer, count, type, rank, tag, communicator);
}

int MPI_Finalize() {
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::fprintf(stderr, "sent by rank %d: %lld messages, %lld bytes\n", rank, static_cast<long long>(messages),
               static_cast<long long>(bytes));
  return PMPI_Finalize();
}

}  // extern "C"
