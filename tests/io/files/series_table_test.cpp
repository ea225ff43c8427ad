// series.csv: header, round trip of every digit, and what a restart keeps.
#include "io/files/series_table.hpp"
#include "core/base/error.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace thalweg::io::series_table_test {
namespace {

using testing::contents;
using testing::message_of;
using testing::ScratchFolder;

std::vector<Diagnostic> row(double q_star, double speed) { return {{"q_star", "1", q_star}, {"speed", "m/s", speed}}; }

const SeriesColumns columns(row(0.0, 0.0));

TEST(SeriesTable, EveryNumberReadsBackToTheSameBits) {
  const ScratchFolder folder;
  const std::vector<double> values{1.0 / 3.0, -4.9406564584124654e-300};
  SeriesTable table(MPI_COMM_WORLD, folder / "series.csv", columns);
  table.append(0.1 + 0.2, row(values[0], values[1]));
  const std::string text = contents(folder / "series.csv");  // on the disk while the table is open
  const std::string header = "time [s],q_star [1],speed [m/s]\n";
  ASSERT_EQ(text.substr(0, header.size()), header);
  double time = 0.0, a = 0.0, b = 0.0;
  ASSERT_EQ(std::sscanf(text.c_str() + header.size(), "%lf,%lf,%lf\n", &time, &a, &b), 3);
  EXPECT_EQ(time, 0.1 + 0.2);
  EXPECT_EQ(a, values[0]);
  EXPECT_EQ(b, values[1]);
}

TEST(SeriesTable, ARestartDropsWhatCameAfterIt) {
  const ScratchFolder folder;
  const auto path = folder / "series.csv";
  {
    SeriesTable table(MPI_COMM_WORLD, path, columns);
    for (int n = 0; n <= 4; ++n) table.append(0.25 * n, row(1.0 * n, 2.0 * n));
  }
  if (rank_of(MPI_COMM_WORLD) == 0) std::ofstream(path, std::ios::app) << "0.25,0.5";  // cut short by a kill
  MPI_Barrier(MPI_COMM_WORLD);
  SeriesTable table(MPI_COMM_WORLD, path, columns, 0.5);
  table.append(0.6, row(7.0, 8.0));
  EXPECT_EQ(contents(path), "time [s],q_star [1],speed [m/s]\n0,0,0\n0.25,1,2\n0.5,2,4\n0.6,7,8\n");
}

TEST(SeriesTable, ARestartGoesOnWithAFileFromWindows) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "series.csv";
  if (rank_of(MPI_COMM_WORLD) == 0)
    testing::put(path, "\xEF\xBB\xBFtime [s],q_star [1],speed [m/s]\r\n0,0,0\r\n0.25,1,2\r\n0.5,2,4\r\n");
  MPI_Barrier(MPI_COMM_WORLD);
  SeriesTable::check_columns(MPI_COMM_WORLD, path, columns);
  SeriesTable table(MPI_COMM_WORLD, path, columns, 0.25);
  table.append(0.3, row(7.0, 8.0));
  EXPECT_EQ(contents(path), "time [s],q_star [1],speed [m/s]\n0,0,0\n0.25,1,2\n0.3,7,8\n");
}

// Rows every 0.1 s, the last of a run at 0.25 s and the next at 0.3 s.
TEST(SeriesTable, TellsThatRowsAreMissing) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "series.csv";
  const auto gap_from = [&](double continue_from) {
    if (rank_of(MPI_COMM_WORLD) == 0)
      testing::put(path, "time [s],q_star [1],speed [m/s]\n0,0,0\n0.1,1,2\n0.2,1,2\n0.25,1,2\n0.3,1,2\n");
    MPI_Barrier(MPI_COMM_WORLD);
    return SeriesTable(MPI_COMM_WORLD, path, columns, continue_from).gap();
  };
  EXPECT_EQ(gap_from(0.399), "");
  EXPECT_EQ(gap_from(0.6), rank_of(MPI_COMM_WORLD) == 0
                               ? "the rows of series.csv end at 0.3 s, and those from there to 0.6 s are missing"
                               : "");
}

TEST(SeriesTable, RowsOfARunThatNoLongerWritesThemAreDropped) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "series.csv";
  SeriesTable::drop_rows_after(MPI_COMM_WORLD, path, 0.2);  // without a file
  EXPECT_FALSE(std::filesystem::exists(path));
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD) == 0) testing::put(path, "time [s],height [m]\n0.1,1\n0.2,2\n0.3,3\n0.15,");
  MPI_Barrier(MPI_COMM_WORLD);
  SeriesTable::drop_rows_after(MPI_COMM_WORLD, path, 0.2);
  EXPECT_EQ(contents(path), "time [s],height [m]\n0.1,1\n0.2,2\n");
}

TEST(SeriesTable, ARowWithOtherColumnsIsRefusedAndNotWritten) {
  const ScratchFolder folder;
  SeriesTable table(MPI_COMM_WORLD, folder / "series.csv", columns);
  const std::vector<Diagnostic> good = row(1.0, 2.0);
  EXPECT_EQ(message_of<std::logic_error>([&] { table.append(0.1, std::vector{good[0]}); }),
            "a row of the series has 1 values for 2 columns");
  EXPECT_EQ(message_of<std::logic_error>([&] {
              table.append(0.1, std::vector{good[1], good[0]});
            }),
            "a row of the series has speed in column q_star");
  table.append(0.2, good);
  EXPECT_EQ(contents(folder / "series.csv"), "time [s],q_star [1],speed [m/s]\n0.2,1,2\n");
}

TEST(SeriesTable, AColumnOfTwoSourcesIsRefused) {
  std::vector<Diagnostic> twice = row(1.0, 2.0);
  twice.push_back({"q_star", "1", 3.0});
  EXPECT_NE(
      message_of<InputError>([&] { SeriesColumns{twice}; }).find("Two columns of the series have the name q_star;"),
      std::string::npos);
}

TEST(SeriesTable, ANewTableForgetsAnOldFile) {
  const ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) == 0) testing::put(folder / "series.csv", "anything\n");
  MPI_Barrier(MPI_COMM_WORLD);
  const SeriesTable table(MPI_COMM_WORLD, folder / "series.csv", columns);
  EXPECT_EQ(contents(folder / "series.csv"), "time [s],q_star [1],speed [m/s]\n");
}

TEST(SeriesTable, AFileWithOtherColumnsIsLeftAlone) {
  const ScratchFolder folder;
  const std::string other = "time [s],height [m]\n0,1\n";
  if (rank_of(MPI_COMM_WORLD) == 0) testing::put(folder / "series.csv", other);
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string message =
      message_of<InputError>([&] { SeriesTable(MPI_COMM_WORLD, folder / "series.csv", columns, 1.0); });
  EXPECT_EQ(message_of<InputError>([&] { SeriesTable::check_columns(MPI_COMM_WORLD, folder / "series.csv", columns); }),
            message);
  EXPECT_NE(message.find(
                "the file has other columns than this run writes, without q_star [1], speed [m/s], with height [m];"),
            std::string::npos)
      << message;
  EXPECT_EQ(contents(folder / "series.csv"), other);
}

TEST(SeriesTable, AMissingFolderIsARunErrorOnEveryRank) {
  const ScratchFolder folder;
  EXPECT_NE(message_of<RunError>([&] { SeriesTable(MPI_COMM_WORLD, folder / "missing/series.csv", columns); }), "");
}

}  // namespace
}  // namespace thalweg::io::series_table_test
