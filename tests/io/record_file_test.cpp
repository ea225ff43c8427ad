// A file that grows: what is added lies behind what was there, and what is later than a restart is dropped.
#include "io/record_file.hpp"

#include "core/error.hpp"
#include "io/hdf5_archive.hpp"
#include "tests/io/scratch_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace thalweg::io::record_file_test {
namespace {

using testing::contents;
using testing::message_of;
using testing::put;
using testing::ScratchFolder;

constexpr int first_events = 12;

// Rows at whole seconds from `first` to before `end`: a number a row and two vectors; an event at each of the first.
Records seconds(int first, int end, std::vector<std::int64_t> id = {4, 7}) {
  Records records;
  if (rank_of(MPI_COMM_WORLD) != 0) return records;
  records.fixed = {{"id", std::move(id)}};
  const auto rows = static_cast<std::uint64_t>(end - first);
  records.rows = {{"time", "s", {}, {rows}, {}}, {"velocity", "m/s", {"x", "y", "z"}, {rows, 2, 3}, {}}};
  for (int t = first; t < end; ++t) {
    records.rows[0].values.push_back(t);
    for (int k = 0; k < 6; ++k) records.rows[1].values.push_back(10.0 * t + k);
    if (t >= first_events) continue;
    records.events.push_back({"event_" + std::to_string(t),
                              static_cast<double>(t),
                              {{"share", "1", 0.25}},
                              {{"partner", {t}}},
                              {{"force", "N", {}, {2}, {1.0 * t, 2.0 * t}}}});
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

void expect_seconds(const std::filesystem::path& path, int end) {
  Hdf5Reader file(MPI_COMM_WORLD, path);
  std::vector<double> times, velocities;
  for (int t = 0; t < end; ++t) {
    times.push_back(t);
    for (int k = 0; k < 6; ++k) velocities.push_back(10.0 * t + k);
    if (t < first_events) {
      EXPECT_EQ(numbers(file, "event_" + std::to_string(t) + "/force"), (std::vector<double>{1.0 * t, 2.0 * t}));
    }
  }
  EXPECT_EQ(numbers(file, "time"), times);
  EXPECT_EQ(numbers(file, "velocity"), velocities);
  EXPECT_EQ(numbers<std::int64_t>(file, "id"), (std::vector<std::int64_t>{4, 7}));
  EXPECT_EQ(file.text_attribute("velocity/components"), "x y z");
  EXPECT_EQ(file.real_attribute("event_0/share"), 0.25);
  EXPECT_FALSE(file.has("event_" + std::to_string(end)));
}

TEST(RecordFile, GrowsAndDropsWhatIsLaterThanARestart) {
  const ScratchFolder folder;
  const auto path = folder / "tracks.h5";
  RecordFile first(MPI_COMM_WORLD, path, std::nullopt);
  first.add(seconds(0, 0));
  first.add(seconds(0, 3));
  first.add(seconds(3, 3));
  first.add(seconds(3, 9));
  expect_seconds(path, 9);
  RecordFile again(MPI_COMM_WORLD, path, 4.0);
  again.add(seconds(5, 5));  // nothing new yet, but what is later is gone
  expect_seconds(path, 5);
  again.add(seconds(5, 2000));  // more than a chunk
  expect_seconds(path, 2000);
  RecordFile anew(MPI_COMM_WORLD, path, std::nullopt);
  anew.add(seconds(0, 2));
  expect_seconds(path, 2);
}

// Of events under a name that the file has, from a part of the run that was watched otherwise, the number goes on.
TEST(RecordFile, EventsGetTheNextFreeNumber) {
  const ScratchFolder folder;
  const auto path = folder / "entrainment.h5";
  const auto event = [](const char* name, double share) {
    Records records;
    if (rank_of(MPI_COMM_WORLD) == 0) records.events = {{name, 1.0, {{"share", "1", share}}, {}, {}}};
    return records;
  };
  RecordFile first(MPI_COMM_WORLD, path, std::nullopt);
  for (const char* name : {"event_000008", "event_000009"}) first.add(event(name, 0.25));
  RecordFile again(MPI_COMM_WORLD, path, 4.0);
  again.add(event("event_000008", 0.5));
  Hdf5Reader file(MPI_COMM_WORLD, path);
  EXPECT_EQ(file.real_attribute("event_000008/share"), 0.25);
  EXPECT_EQ(file.real_attribute("event_000010/share"), 0.5);
}

// A reader, as the Python package is one, does not keep the run from writing.
TEST(RecordFile, IsWrittenWhileSomebodyReadsIt) {
  const ScratchFolder folder;
  const auto path = folder / "tracks.h5";
  RecordFile file(MPI_COMM_WORLD, path, std::nullopt);
  file.add(seconds(0, 3));
  {
    Hdf5Reader reader(MPI_COMM_SELF, path);
    EXPECT_EQ(numbers(reader, "time").size(), 3u);
    MPI_Barrier(MPI_COMM_WORLD);
    file.add(seconds(3, 6));
  }
  MPI_Barrier(MPI_COMM_WORLD);
  expect_seconds(path, 6);
}

// Rows of which a crash has left some arrays shorter than others, or times that were never written.
TEST(RecordFile, GoesOnBehindTheLastWholeRow) {
  const ScratchFolder folder;
  const auto path = folder / "tracks.h5";
  RecordFile(MPI_COMM_WORLD, path, std::nullopt).add(seconds(0, 5));
  Records hole = seconds(5, 8);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    hole.rows[0].values = {5.0, 0.0, 0.0};
    hole.events.resize(1);
  }
  RecordFile(MPI_COMM_WORLD, path, 5.0).add(hole);
  RecordFile again(MPI_COMM_WORLD, path, 7.0);
  again.add(seconds(6, 6));
  expect_seconds(path, 6);
  again.add(seconds(6, 9));
  expect_seconds(path, 9);
}

// The bytes of a new file with rows up to before `end`.
std::string file_until(int end, const std::filesystem::path& path) {
  RecordFile(MPI_COMM_WORLD, path, std::nullopt).add(seconds(0, end));
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string bytes = contents(path);
  MPI_Barrier(MPI_COMM_WORLD);
  return bytes;
}

// Goes on at 3 s with a file of this content, which must be set aside as it is.
void expect_begun_anew(const ScratchFolder& folder, const std::string& content, int number) {
  const auto path = folder / "tracks.h5", aside = folder / fmt::format("tracks.damaged_{}.h5", number);
  if (rank_of(MPI_COMM_WORLD) == 0) put(path, content);
  MPI_Barrier(MPI_COMM_WORLD);
  RecordFile again(MPI_COMM_WORLD, path, 2.0);
  again.check(seconds(3, 3));
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_TRUE(contents(path) == content);  // nothing is touched before add()
  }
  again.add(seconds(3, 3));
  again.add(seconds(3, 5));
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_EQ(again.warning(),
              fmt::format("{} is damaged, as by a kill while it was being written, and cannot be "
                          "continued: it is kept as tracks.damaged_{}.h5, and a new file begins at 2 s",
                          path.string(), number));
    EXPECT_TRUE(contents(aside) == content);
  }
  Hdf5Reader file(MPI_COMM_WORLD, path);
  EXPECT_EQ(numbers(file, "time"), (std::vector<double>{3.0, 4.0}));
  MPI_Barrier(MPI_COMM_WORLD);
}

// No byte of it is lost, and none of an earlier one.
TEST(RecordFile, SetsADamagedFileAsideAndBeginsAnew) {
  const ScratchFolder folder;
  const auto path = folder / "tracks.h5";
  const std::string whole = file_until(2000, path);
  int number = 1;
  expect_begun_anew(folder, "", number++);
  expect_begun_anew(folder, "no HDF5", number++);
  expect_begun_anew(folder, whole.substr(0, whole.size() / 2), number++);
  expect_begun_anew(folder, whole.substr(0, whole.size() - 1), number++);
  std::string garbage = whole;
  garbage.replace(40, 60, 60, '\x5a');
  expect_begun_anew(folder, garbage, number++);
}

// Whatever is wrong with it, a file is continued, set aside, or (where numbers of its header have changed) refused.
TEST(RecordFile, GarbageAnywhereEndsInGoodOrder) {
  const ScratchFolder folder;
  const auto path = folder / "tracks.h5";
  const std::string whole = file_until(20, path);
  int set_aside = 0;
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 150);
  for (std::size_t at = 0; at + 16 < whole.size(); at += step) {
    std::string garbage = whole;
    garbage.replace(at, 16, 16, '\xa5');
    if (rank_of(MPI_COMM_WORLD) == 0) put(path, garbage);
    MPI_Barrier(MPI_COMM_WORLD);
    RecordFile again(MPI_COMM_WORLD, path, 9.0);
    const std::string refused = message_of<InputError>([&] {
      again.add(seconds(10, 10));
      again.add(seconds(10, 12));
    });
    EXPECT_TRUE(refused.empty() || refused.find("its id is not that of this run") != std::string::npos)
        << at << refused;
    set_aside += again.warning().empty() ? 0 : 1;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_GT(set_aside, 5);
  }
}

TEST(RecordFile, RefusesWhatItCannotContinue) {
  const ScratchFolder folder;
  const auto path = folder / "tracks.h5";
  RecordFile(MPI_COMM_WORLD, path, std::nullopt).add(seconds(0, 3));
  RecordFile other(MPI_COMM_WORLD, path, 2.0);
  EXPECT_NE(message_of<InputError>([&] {
              other.add(seconds(3, 3, {4, 8}));
            }).find("its id is not that of this run; move"),
            std::string::npos);
  RecordFile nowhere(MPI_COMM_WORLD, folder / "missing/tracks.h5", std::nullopt);
  EXPECT_NE(message_of<RunError>([&] { nowhere.add(seconds(0, 1)); }).find("cannot write the file"), std::string::npos);
}

}  // namespace
}  // namespace thalweg::io::record_file_test
