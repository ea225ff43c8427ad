#include "core/parallel/mpi_session.hpp"
#include "core/parallel/packed_exchange.hpp"
#include "core/parallel/wide_rows.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace thalweg::exchange_test {
namespace {

TEST(ExchangeRows, DeliversInOrderOfTheSendingRank) {
  const int rank = rank_of(MPI_COMM_WORLD), ranks = size_of(MPI_COMM_WORLD);
  struct Row {
    int from, to, serial;
  };
  std::vector<Row> rows;
  std::vector<int> destination;
  for (int serial = 0; serial < 3; ++serial)
    for (int to = 0; to < ranks; ++to) {
      rows.push_back({rank, to, serial});
      destination.push_back(to);
    }
  const std::vector<Row> received = exchange_rows(MPI_COMM_WORLD, rows, destination);
  ASSERT_EQ(received.size(), 3u * ranks);
  for (int i = 0; i < 3 * ranks; ++i) {
    EXPECT_EQ(received[i].to, rank);
    EXPECT_EQ(received[i].from, i / 3);
    EXPECT_EQ(received[i].serial, i % 3);
  }
}

// Row n of a rank is three values, to rank (rank + n) mod ranks; the last has none where there are several.
TEST(ExchangeWideRows, DeliversWholeRowsInOrderOfTheSendingRank) {
  const int rank = rank_of(MPI_COMM_WORLD), ranks = size_of(MPI_COMM_WORLD);
  const auto rows_of = [ranks](int from) { return ranks > 1 && from == ranks - 1 ? 0 : 2 * ranks + 1; };
  std::vector<double> values;
  std::vector<int> destination;
  for (int n = 0; n < rows_of(rank); ++n) {
    values.insert(values.end(), {1.0 * rank, 1.0 * n, 0.5});
    destination.push_back((rank + n) % ranks);
  }
  std::vector<double> expected;
  for (int from = 0; from < ranks; ++from)
    for (int n = 0; n < rows_of(from); ++n)
      if ((from + n) % ranks == rank) expected.insert(expected.end(), {1.0 * from, 1.0 * n, 0.5});
  EXPECT_EQ(exchange_wide_rows(MPI_COMM_WORLD, values, 3, destination), expected);
  EXPECT_TRUE(exchange_wide_rows(MPI_COMM_WORLD, std::vector<double>{}, 0, destination).empty());
}

// Many exchanges in a row with nothing between them, each rank with other partners in each and some with none, so that
// ranks that are early send for the next exchange while others are in the last.
TEST(ExchangeRows, KeepsExchangesApartThatFollowEachOther) {
  const int rank = rank_of(MPI_COMM_WORLD), ranks = size_of(MPI_COMM_WORLD);
  struct Row {
    int from, round, serial;
  };
  const auto count = [](int from, int to, int round) { return (7 * from + 3 * to + round) % 4; };  // 0 to 3 rows
  for (int round = 0; round < 400; ++round) {
    std::vector<Row> rows;
    std::vector<int> destination;
    for (int to = ranks - 1; to >= 0; --to)
      for (int serial = 0; serial < count(rank, to, round); ++serial) {
        rows.push_back({rank, round, serial});
        destination.push_back(to);
      }
    const std::vector<Row> received = exchange_rows(MPI_COMM_WORLD, rows, destination);
    std::size_t next = 0;
    for (int from = 0; from < ranks; ++from)
      for (int serial = 0; serial < count(from, rank, round); ++serial, ++next) {
        ASSERT_LT(next, received.size());
        ASSERT_EQ(received[next].from, from);
        ASSERT_EQ(received[next].round, round);
        ASSERT_EQ(received[next].serial, serial);
      }
    ASSERT_EQ(next, received.size());
  }
}

// Communicators that share ranks count their exchanges separately.
TEST(ExchangeRows, WorksInPartsOfTheRanks) {
  const int rank = rank_of(MPI_COMM_WORLD);
  MPI_Comm half;
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, rank, &half);
  if (rank % 2 == 0) {
    const std::size_t expected = rank == 0 ? static_cast<std::size_t>(size_of(half)) : 0;
    EXPECT_EQ(exchange_rows(half, std::vector<int>{5}, {0}).size(), expected);
  }
  EXPECT_EQ(exchange_rows(MPI_COMM_WORLD, std::vector<int>{rank}, {rank}), std::vector<int>{rank});
  EXPECT_EQ(exchange_rows(half, std::vector<int>{rank}, {rank_of(half)}), std::vector<int>{rank});
  MPI_Comm_free(&half);
}

TEST(PackedExchange, RingPassesAgainAndAgain) {
  const int rank = rank_of(MPI_COMM_WORLD), ranks = size_of(MPI_COMM_WORLD);
  const int left = (rank + ranks - 1) % ranks, right = (rank + 1) % ranks;
  // On one or two ranks both neighbours are the same rank; tags keep the two directions apart.
  PackedExchange ring(MPI_COMM_WORLD,
                      {{right, 0, 1, sizeof(int), sizeof(int)}, {left, 1, 0, sizeof(int), sizeof(int)}});
  for (int round = 0; round < 10; ++round) {
    *ring.send_buffer<int>(0) = 100 * rank + round;
    *ring.send_buffer<int>(1) = -100 * rank - round;
    ring.start();
    ring.finish();
    EXPECT_EQ(*ring.receive_buffer<int>(0), -100 * right - round);
    EXPECT_EQ(*ring.receive_buffer<int>(1), 100 * left + round);
  }
}

}  // namespace
}  // namespace thalweg::exchange_test
