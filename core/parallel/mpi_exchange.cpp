#include "core/base/check.hpp"
#include "core/parallel/mpi_count.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace thalweg::detail {

namespace {

struct Tags {
  int counts, rows;
};

// Two pairs used in turn: a rank that has left one exchange may already send for the next while another has yet to see
// that the first is over. It cannot be two ahead, since the barrier between needs every rank.
Tags tags_of_exchange(MPI_Comm communicator) {
  static int keyval = [] {
    int created = MPI_KEYVAL_INVALID;
    MPI_Comm_create_keyval(
        MPI_COMM_NULL_COPY_FN,
        [](MPI_Comm, int, void* value, void*) {
          delete static_cast<int*>(value);
          return MPI_SUCCESS;
        },
        &created, nullptr);
    return created;
  }();
  int* turn = nullptr;
  int found = 0;
  MPI_Comm_get_attr(communicator, keyval, &turn, &found);
  if (!found) MPI_Comm_set_attr(communicator, keyval, turn = new int(0));
  *turn = 1 - *turn;
  constexpr int first_tag = 29100;  // not used elsewhere
  return {first_tag + *turn, first_tag + 2 + *turn};
}

MPI_Datatype bytes_of(std::size_t row_size) {
  MPI_Datatype row;
  MPI_Type_contiguous(static_cast<int>(row_size), MPI_BYTE, &row);
  MPI_Type_commit(&row);
  return row;
}

// The first parcel for this rank or a higher one; parcels are in order of rank.
std::vector<Parcel>::iterator first_from(int rank, std::vector<Parcel>& parcels) {
  return std::lower_bound(parcels.begin(), parcels.end(), rank,
                          [](const Parcel& parcel, int wanted) { return parcel.rank < wanted; });
}

// Senders of rows to this rank, and their numbers of rows, in the order of ranks.
std::vector<Parcel> announced(MPI_Comm communicator, int tag, const std::vector<Parcel>& parcels) {
  std::vector<std::uint64_t> counts(parcels.size());
  std::vector<MPI_Request> sends(parcels.size());
  for (std::size_t n = 0; n < parcels.size(); ++n) {
    counts[n] = parcels[n].count;
    // Synchronous: complete only once received, which is what the barrier below relies on.
    MPI_Issend(&counts[n], 1, MPI_UINT64_T, parcels[n].rank, tag, communicator, &sends[n]);
  }

  // A rank whose messages have all been received enters the barrier; once all have, no message is under way.
  std::vector<Parcel> senders;
  MPI_Request barrier = MPI_REQUEST_NULL;
  for (int over = 0; !over;) {
    MPI_Status status;
    MPI_Message message;
    int come = 0;
    MPI_Improbe(MPI_ANY_SOURCE, tag, communicator, &come, &message, &status);
    if (come) {
      std::uint64_t count = 0;
      MPI_Mrecv(&count, 1, MPI_UINT64_T, &message, MPI_STATUS_IGNORE);
      senders.push_back({status.MPI_SOURCE, 0, count});
    } else if (barrier != MPI_REQUEST_NULL) {
      MPI_Test(&barrier, &over, MPI_STATUS_IGNORE);
    } else {
      int received = 0;
      MPI_Testall(static_cast<int>(sends.size()), sends.data(), &received, MPI_STATUSES_IGNORE);
      if (received) MPI_Ibarrier(communicator, &barrier);
    }
  }
  std::sort(senders.begin(), senders.end(), [](const Parcel& a, const Parcel& b) { return a.rank < b.rank; });
  return senders;
}

}  // namespace

std::vector<Parcel> parcels_to(const std::vector<int>& destination) {
  std::vector<Parcel> parcels;
  int previous = -1;
  for (const int rank : destination) {
    if (rank == previous) continue;
    previous = rank;
    const auto place = first_from(rank, parcels);
    if (place == parcels.end() || place->rank != rank) parcels.insert(place, Parcel{rank});
  }
  for (const int rank : destination) ++parcel_to(rank, parcels).count;
  std::size_t first = 0;
  for (Parcel& parcel : parcels) {
    parcel.first = first;
    first += std::exchange(parcel.count, 0);
  }
  return parcels;
}

Parcel& parcel_to(int rank, std::vector<Parcel>& parcels) { return *first_from(rank, parcels); }

void exchange_parcels(MPI_Comm communicator, const std::vector<Parcel>& parcels, const void* packed,
                      std::size_t row_size, const std::function<void*(std::size_t)>& place) {
  const int self = rank_of(communicator);
  CHECK(parcels.empty() || (parcels.front().rank >= 0 && parcels.back().rank < size_of(communicator)));
  const Tags tags = tags_of_exchange(communicator);
  const auto* rows = static_cast<const std::byte*>(packed);
  std::vector<Parcel> elsewhere, senders;
  for (const Parcel& parcel : parcels)
    if (parcel.rank != self) elsewhere.push_back(parcel);
  if (size_of(communicator) > 1) senders = announced(communicator, tags.counts, elsewhere);
  for (const Parcel& parcel : parcels)
    if (parcel.rank == self) senders.insert(first_from(self, senders), parcel);

  std::size_t arriving = 0;
  for (const Parcel& sender : senders) arriving += sender.count;
  auto* next = static_cast<std::byte*>(place(arriving));
  MPI_Datatype row = bytes_of(row_size);
  std::vector<MPI_Request> requests;
  for (const Parcel& sender : senders) {
    if (sender.rank == self)
      std::memcpy(next, rows + sender.first * row_size, sender.count * row_size);
    else
      MPI_Irecv(next, mpi_count(sender.count), row, sender.rank, tags.rows, communicator, &requests.emplace_back());
    next += sender.count * row_size;
  }
  for (const Parcel& parcel : elsewhere)
    MPI_Isend(rows + parcel.first * row_size, mpi_count(parcel.count), row, parcel.rank, tags.rows, communicator,
              &requests.emplace_back());
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  MPI_Type_free(&row);
}

}  // namespace thalweg::detail
