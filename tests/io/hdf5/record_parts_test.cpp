// Parts of what is recorded: together they hold all of it, and what is later than a restart is dropped.
#include "io/hdf5/record_parts.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "tests/io/scratch_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace thalweg::io::record_parts_test {
namespace {

using testing::message_of;
using testing::put;
using testing::ScratchFolder;

constexpr int first_events = 12;

// Rows at whole seconds from `first` to before `end`: a number a row and two vectors; an event at each of the first.
Records seconds(int first, int end, std::vector<std::int64_t> id = {4, 7}, double x = 0.5) {
  Records records;
  if (rank_of(MPI_COMM_WORLD) != 0) return records;
  records.fixed = {{"id", "id", std::move(id)}};
  records.places = {{"x", "m", {"x"}, {}, {3}, {x, 1.5, 2.5}}};
  const auto rows = static_cast<std::uint64_t>(end - first);
  records.rows = {{"time", "s", {"time"}, {}, {rows}, {}},
                  {"velocity", "m/s", {"time", "id"}, {"x", "y", "z"}, {rows, 2, 3}, {}}};
  for (int t = first; t < end; ++t) {
    records.rows[0].values.push_back(t);
    for (int k = 0; k < 6; ++k) records.rows[1].values.push_back(10.0 * t + k);
    if (t >= first_events) continue;
    records.events.push_back({"event_" + std::to_string(t),
                              static_cast<double>(t),
                              {{"share", "1", 0.25}},
                              {{"partner", "contact", {t}}},
                              {{"force", "N", {"time"}, {}, {2}, {1.0 * t, 2.0 * t}}}});
  }
  return records;
}

template <typename Number = double>
std::vector<Number> numbers(Hdf5Reader& file, const std::string& name) {
  const std::vector<std::uint64_t> shape = file.shape(name);
  std::vector<Number> values(std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>()));
  file.read(name, std::span<Number>(values), {shape, std::vector<std::uint64_t>(shape.size(), 0), shape});
  return values;
}

// Rows of each part, by name; times and velocities must be those of seconds().
std::vector<std::pair<std::string, std::vector<double>>> parts_in(const std::filesystem::path& folder) {
  MPI_Barrier(MPI_COMM_WORLD);
  std::vector<std::pair<std::string, std::vector<double>>> parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    Hdf5Reader file(entry.path());
    parts.emplace_back(entry.path().filename().string(), numbers(file, "time"));
    std::vector<double> velocities;
    for (const double t : parts.back().second) {
      for (int k = 0; k < 6; ++k) velocities.push_back(10.0 * t + k);
      if (t >= first_events) continue;
      const std::string event = fmt::format("event_{}", t);
      EXPECT_EQ(numbers(file, event + "/force"), (std::vector<double>{t, 2.0 * t}));
      EXPECT_EQ(numbers<std::int64_t>(file, event + "/partner"), std::vector<std::int64_t>{static_cast<int>(t)});
      EXPECT_EQ(file.real_attribute(event + "/share"), 0.25);
      EXPECT_EQ(file.real_attribute(event + "/time"), t);
    }
    EXPECT_EQ(numbers(file, "velocity"), velocities);
    EXPECT_EQ(numbers<std::int64_t>(file, "id"), (std::vector<std::int64_t>{4, 7}));
    EXPECT_EQ(numbers(file, "x"), (std::vector<double>{0.5, 1.5, 2.5}));
    EXPECT_EQ(file.text_attribute("velocity/components"), "x y z");
    EXPECT_EQ(file.text_attribute("velocity/units"), "m/s");
  }
  std::sort(parts.begin(), parts.end());
  MPI_Barrier(MPI_COMM_WORLD);
  return parts;
}

using Parts = std::vector<std::pair<std::string, std::vector<double>>>;
const Parts to_nine{
    {"part_000000000.h5", {}}, {"part_000000003.h5", {0, 1, 2, 3}}, {"part_000000009.h5", {4, 5, 6, 7, 8}}};

// A second a step: checkpoints at steps 3 and 9.
void record_to_nine(const std::filesystem::path& folder) {
  RecordParts parts(MPI_COMM_WORLD, folder, std::nullopt);
  parts.begin(seconds(0, 0), 0);
  parts.add(seconds(0, 3), 2);
  parts.add(seconds(3, 4), 3);
  parts.write(3);
  parts.add(seconds(4, 4), 4);
  parts.add(seconds(4, 9), 9);
  parts.write(9);
  parts.write(9);  // nothing is left to write
}

TEST(RecordParts, HoldWhatWasAddedBetweenCheckpoints) {
  const ScratchFolder folder;
  record_to_nine(folder / "tracks");
  EXPECT_EQ(parts_in(folder / "tracks"), to_nine);
}

TEST(RecordParts, AreDroppedByARestartWhereTheyAreLater) {
  const ScratchFolder folder;
  record_to_nine(folder / "tracks");
  if (rank_of(MPI_COMM_WORLD) == 0) {
    put(folder / "tracks/part_000000012.h5", "damaged");  // it is not looked into
    put(folder / "tracks/part_000000003.h5.partial", "of a kill");
    put(folder / "tracks/part_000000003.h5.partial.locktest.0", "of a kill");
    put(folder / "tracks/notes.txt", "somebody else's");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  RecordParts again(MPI_COMM_WORLD, folder / "tracks", 3);
  again.check(seconds(4, 4));
  EXPECT_TRUE(std::filesystem::exists(folder / "tracks/part_000000009.h5"));  // nothing is touched yet
  MPI_Barrier(MPI_COMM_WORLD);
  again.begin(seconds(4, 4), 3);
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_TRUE(std::filesystem::remove(folder / "tracks/notes.txt"));
  }
  EXPECT_EQ(parts_in(folder / "tracks"), Parts(to_nine.begin(), to_nine.begin() + 2));
  again.add(seconds(4, 9), 9);
  again.write(9);
  EXPECT_EQ(parts_in(folder / "tracks"), to_nine);
}

TEST(RecordParts, OfANewRunAreNotMixedWithThoseOfAnother) {
  const ScratchFolder folder;
  record_to_nine(folder / "tracks");
  {
    RecordParts anew(MPI_COMM_WORLD, folder / "tracks", std::nullopt);
    anew.begin(seconds(0, 0), 0);
  }
  EXPECT_EQ(parts_in(folder / "tracks"), Parts(to_nine.begin(), to_nine.begin() + 1));
}

// Rows that are many, or of a run that ends by an error, do not wait for a checkpoint.
TEST(RecordParts, AreWrittenBeforeTheCheckpointToo) {
  const ScratchFolder folder;
  constexpr int many = 320000;  // of 56 bytes
  {
    RecordParts parts(MPI_COMM_WORLD, folder / "tracks", std::nullopt);
    parts.begin(seconds(0, 0), 0);
    parts.add(seconds(20, 20 + many), 100);
    parts.add(seconds(20 + many, 30 + many), 200);
  }
  const Parts found = parts_in(folder / "tracks");
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[1].first, "part_000000100.h5");
  EXPECT_EQ(found[1].second.size(), static_cast<std::size_t>(many));
  EXPECT_EQ(found[2].first, "part_000000200.h5");
  EXPECT_EQ(found[2].second.size(), 10u);
}

TEST(RecordParts, RefuseWhatTheyCannotContinue) {
  const ScratchFolder folder;
  record_to_nine(folder / "tracks");
  const RecordParts other(MPI_COMM_WORLD, folder / "tracks", 5);
  const auto refused = [&](const std::vector<std::int64_t>& id, double x = 0.5) {
    return message_of<InputError>([&] { other.check(seconds(3, 3, id, x)); });
  };
  EXPECT_EQ(refused({4, 7}), "");
  EXPECT_NE(refused({4, 8}).find("its id is not that of this run; move the folder tracks away"), std::string::npos);
  EXPECT_NE(refused({4, 7}, 0.6).find("its x is not that of this run"), std::string::npos);
  if (rank_of(MPI_COMM_WORLD) == 0) put(folder / "tracks/part_000000003.h5", "damaged");
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NE(refused({4, 7}).find("part_000000003.h5: the records cannot be continued, it is damaged"),
            std::string::npos);
}

TEST(RecordParts, ThatCannotBeWrittenAreARunErrorOnEveryRank) {
  const ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) == 0) put(folder / "tracks", "a file where the folder should be");
  MPI_Barrier(MPI_COMM_WORLD);
  RecordParts parts(MPI_COMM_WORLD, folder / "tracks", std::nullopt);
  EXPECT_NE(message_of<RunError>([&] { parts.begin(seconds(0, 0), 0); }), "");
}

}  // namespace
}  // namespace thalweg::io::record_parts_test
