// Checkpoints: what is written reads back on any ranks, and the bytes of the file do not depend on the ranks.
#include "io/hdf5/hdf5_archive.hpp"
#include "core/base/error.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/parallel/mpi_session.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <hdf5.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <semaphore.h>
#include <sys/resource.h>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

// Whether this rank fails to open the next files.
static bool fails_to_open = false;

// HDF5's own functions, but for a rank that fails: it takes part, since the call is collective, and has no file then.
template <typename... Arguments>
static hid_t opened_by_hdf5(const char* function, Arguments... arguments) {
  const auto own = reinterpret_cast<hid_t (*)(Arguments...)>(::dlsym(RTLD_NEXT, function));
  const hid_t file = own(arguments...);
  return fails_to_open ? H5I_INVALID_HID : file;
}
extern "C" hid_t H5Fopen(const char* name, unsigned flags, hid_t access) {
  return opened_by_hdf5("H5Fopen", name, flags, access);
}
extern "C" hid_t H5Fcreate(const char* name, unsigned flags, hid_t creation, hid_t access) {
  return opened_by_hdf5("H5Fcreate", name, flags, creation, access);
}

namespace thalweg::io::hdf5_archive_test {
namespace {

using testing::contents;
using testing::message_of;
using testing::ScratchFolder;

constexpr Index3 cells{16, 12, 9};

// A number that belongs to a cell alone.
double cell_value(int i, int j, int k) { return 1e-3 * i + 0.7 * j - 1e3 * k + 1.0 / (1.0 + i + 3 * j); }

struct Piece {
  ArrayBox box;
  std::vector<double> values;
};

Piece piece_of(const Block& block) {
  const auto size = block.size();
  Piece piece;
  for (const int axis : {2, 1, 0}) {
    piece.box.global_shape.push_back(static_cast<std::uint64_t>(cells[axis]));
    piece.box.offset.push_back(static_cast<std::uint64_t>(block.lower[axis]));
    piece.box.shape.push_back(static_cast<std::uint64_t>(size[axis]));
  }
  for (int k = block.lower[2]; k < block.upper[2]; ++k)
    for (int j = block.lower[1]; j < block.upper[1]; ++j)
      for (int i = block.lower[0]; i < block.upper[0]; ++i) piece.values.push_back(cell_value(i, j, k));
  return piece;
}

Piece piece_of(MPI_Comm communicator) {
  const Decomposition decomposition(cells, 1.0, {true, true, false},
                                    Decomposition::best_layout(cells, size_of(communicator)));
  return piece_of(decomposition.block_of(rank_of(communicator)));
}

// A list of 11 ids of which only the last rank holds any, as contacts on few ranks would be.
ArrayBox list_box(MPI_Comm communicator) {
  const bool last = rank_of(communicator) == size_of(communicator) - 1;
  return {{11}, {last ? 0u : 11u}, {last ? 11u : 0u}};
}

void write_all(MPI_Comm communicator, const std::filesystem::path& path) {
  Hdf5Writer writer(communicator, path);
  const Piece piece = piece_of(communicator);
  const std::vector<float> single(piece.values.begin(), piece.values.end());
  const ArrayBox ids_box = list_box(communicator);
  std::vector<std::int64_t> ids(ids_box.shape[0]);
  for (std::size_t n = 0; n < ids.size(); ++n) ids[n] = 1000000007LL * static_cast<std::int64_t>(n) - 5;
  writer.attribute("step", std::int64_t{123456789012});
  writer.write("fluid/f", std::span<const double>(piece.values), piece.box);
  writer.write("fluid/single", std::span<const float>(single), piece.box);
  writer.attribute("fluid/density", 1.0 / 3.0);
  writer.write("grains/deep/id", std::span<const std::int64_t>(ids), ids_box);
  writer.write("grains/none", std::span<const double>(), ArrayBox{{0}, {0}, {0}});
  writer.attribute("grains/name", std::string("glass, 5 mm: \xc2\xb5 = 0.5"));
  writer.close();
}

// All that write_all() has written, each rank its own piece of the fields and the whole list of ids.
void expect_what_was_written(Hdf5Reader& reader) {
  const Piece expected = piece_of(MPI_COMM_WORLD);
  std::vector<double> values(expected.values.size());
  reader.read("fluid/f", std::span<double>(values), expected.box);
  EXPECT_EQ(values, expected.values);
  std::vector<float> single(values.size());
  reader.read("fluid/single", std::span<float>(single), expected.box);
  EXPECT_EQ(single, std::vector<float>(expected.values.begin(), expected.values.end()));
  std::vector<std::int64_t> ids(11);
  reader.read("grains/deep/id", std::span<std::int64_t>(ids), ArrayBox{{11}, {0}, {11}});
  EXPECT_EQ(ids[3], 3000000016LL);
  EXPECT_EQ(ids[10], 10000000065LL);
  reader.read("grains/none", std::span<double>(), ArrayBox{{0}, {0}, {0}});
  EXPECT_EQ(reader.integer_attribute("step"), 123456789012);
  EXPECT_EQ(reader.real_attribute("fluid/density"), 1.0 / 3.0);
  EXPECT_EQ(reader.text_attribute("grains/name"), "glass, 5 mm: \xc2\xb5 = 0.5");
}

TEST(Hdf5Archive, ReadsBackTheSameBits) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");

  Hdf5Reader reader(MPI_COMM_WORLD, folder / "state.h5");
  expect_what_was_written(reader);
  EXPECT_EQ(reader.shape("fluid/f"), (std::vector<std::uint64_t>{9, 12, 16}));
  EXPECT_TRUE(reader.has("fluid/f") && reader.has("fluid/density") && reader.has("grains/none"));
  EXPECT_FALSE(reader.has("fluid/g") || reader.has("absent/f") || reader.has("absent"));

  const auto datasets = reader.datasets();
  ASSERT_EQ(datasets.size(), 4u);
  EXPECT_EQ(datasets[0].path, "fluid/f");
  EXPECT_EQ(datasets[0].type, "float64");
  EXPECT_EQ(datasets[2].path, "grains/deep/id");
  EXPECT_EQ(datasets[2].type, "int64");
}

// The state left by a process killed while it opens such a file: Open MPI's semaphore of this name is taken.
TEST(Hdf5Archive, IsNotHeldUpByWhoHasBeenKilled) {
  const ScratchFolder folder;
  for (const char* name : {"held_up.h5.partial", "held_up.h5"})
    if (sem_t* left = sem_open((std::string("OMPIO_") + name).c_str(), O_CREAT, 0644, 0); left != SEM_FAILED)
      sem_close(left);
  MPI_Barrier(MPI_COMM_WORLD);
  write_all(MPI_COMM_WORLD, folder / "held_up.h5");
  Hdf5Reader reader(MPI_COMM_WORLD, folder / "held_up.h5");
  expect_what_was_written(reader);
}

TEST(Hdf5Archive, ABoxThatCrossesTheWritersBlocksReadsBack) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");
  Hdf5Reader reader(MPI_COMM_WORLD, folder / "state.h5");
  const int rank = rank_of(MPI_COMM_WORLD);
  const Piece expected = piece_of(Block{{rank, 1, 2}, {rank + 7, 11, 9}});
  std::vector<double> values(expected.values.size());
  reader.read("fluid/f", std::span<double>(values), expected.box);
  EXPECT_EQ(values, expected.values);
}

// The file of all ranks together against that of one rank alone: what one rank writes is the same in every run of this
// test, so files of 1, 2, 4 and 8 ranks are equal to each other.
TEST(Hdf5Archive, BytesDoNotDependOnRanksOrTheTimeOfDay) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "together.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the clock of HDF5's time stamps ticks in seconds
  if (rank_of(MPI_COMM_WORLD) == 0) {
    write_all(MPI_COMM_SELF, folder / "alone.h5");
    const std::string together = contents(folder / "together.h5"), alone = contents(folder / "alone.h5");
    EXPECT_GT(alone.size(), 16u * 12 * 9 * 12);
    EXPECT_TRUE(together == alone) << together.size() << " and " << alone.size() << " bytes";
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST(Hdf5Archive, ReadErrorsNameFileAndPath) {
  const ScratchFolder folder;
  const auto path = folder / "state.h5";
  write_all(MPI_COMM_WORLD, path);
  Hdf5Reader reader(MPI_COMM_WORLD, path);
  std::vector<double> four(4);
  const auto error_reading = [&](const std::string& name, const ArrayBox& box) {
    return message_of<InputError>([&] { reader.read(name, std::span<double>(four), box); });
  };
  const ArrayBox row{{4}, {0}, {4}};
  EXPECT_EQ(error_reading("grains/mass", row).find(path.string() + ": grains/mass: the file has no such data"), 0u);
  EXPECT_NE(error_reading("fluid/f", row).find("fluid/f: the file holds 9 x 12 x 16 values, but 4 are needed"),
            std::string::npos);
  EXPECT_NE(error_reading("fluid/single", row).find("the file holds float32, but float64 is needed"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { reader.real_attribute("step"); }).find("step: the attribute is not of type"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { reader.text_attribute("fluid/name"); }).find("no such attribute"),
            std::string::npos);
  EXPECT_NE(
      message_of<InputError>([&] { Hdf5Reader(MPI_COMM_WORLD, folder / "none.h5"); }).find("there is no such file"),
      std::string::npos);
  // A link to itself cannot be read by root either. It is no damage, for which an earlier checkpoint would be taken.
  if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::create_symlink("loop.h5", folder / "loop.h5");
  MPI_Barrier(MPI_COMM_WORLD);
  try {
    Hdf5Reader(MPI_COMM_WORLD, folder / "loop.h5");
    ADD_FAILURE() << "it was read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              (folder / "loop.h5").string() + ": cannot read the file: Too many levels of symbolic links.");
    EXPECT_EQ(dynamic_cast<const DamagedFile*>(&error), nullptr);
  }
  if (rank_of(MPI_COMM_WORLD) == 0) testing::put(folder / "text.h5", "not HDF5");
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NE(message_of<InputError>([&] { Hdf5Reader(MPI_COMM_WORLD, folder / "text.h5"); }).find("not an HDF5 file"),
            std::string::npos);
}

// False if the file is refused as damaged.
bool reads_what_was_written(const std::filesystem::path& path) {
  try {
    Hdf5Reader reader(MPI_COMM_WORLD, path);
    expect_what_was_written(reader);
  } catch (const DamagedFile&) {
    return false;
  }
  return true;
}

// Wherever a bit changes, the file is refused or, where the bit has no meaning, reads as it was written.
TEST(Hdf5Archive, ABitThatHasChangedIsNoticed) {
  const ScratchFolder folder;
  const auto whole = folder / "state.h5", damaged = folder / "damaged.h5";
  write_all(MPI_COMM_WORLD, whole);
  EXPECT_TRUE(reads_what_was_written(whole));
  const std::string before = contents(whole);
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 0; at < before.size(); at += at < 4096 ? 13 : 1009) {
    if (rank_of(MPI_COMM_WORLD) == 0) {
      std::string text = before;
      text[at] = static_cast<char>(text[at] ^ (1 << at % 8));
      testing::put(damaged, text);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    ++tried;
    refused += reads_what_was_written(damaged) ? 0 : 1;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  EXPECT_GT(refused, tried / 2);
}

TEST(Hdf5Archive, AFileCutShortIsRefused) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");
  const std::string before = contents(folder / "state.h5");
  for (const std::size_t length : {std::size_t{0}, std::size_t{100}, before.size() / 2, before.size() - 1}) {
    if (rank_of(MPI_COMM_WORLD) == 0) testing::put(folder / "short.h5", before.substr(0, length));
    MPI_Barrier(MPI_COMM_WORLD);
    EXPECT_FALSE(reads_what_was_written(folder / "short.h5")) << length;
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

// Boxes that overlap are as many values as the dataset has, but not the dataset.
TEST(Hdf5Archive, ReadingPartsRaisesNoFalseAlarm) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");
  Hdf5Reader reader(MPI_COMM_WORLD, folder / "state.h5");
  const int ranks = size_of(MPI_COMM_WORLD);
  ASSERT_EQ(cells[0] % ranks, 0);
  const Piece part = piece_of(Block{{0, 0, 0}, {cells[0] / ranks, cells[1], cells[2]}});
  std::vector<double> values(part.values.size());
  reader.read("fluid/f", std::span<double>(values), part.box);
  EXPECT_EQ(values, part.values);
}

TEST(Hdf5Archive, TheNameNeverStandsForAnUnfinishedFile) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");
  const std::string before = contents(folder / "state.h5");
  {
    Hdf5Writer writer(MPI_COMM_WORLD, folder / "state.h5");
    writer.attribute("step", std::int64_t{1});
    EXPECT_TRUE(contents(folder / "state.h5") == before);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_TRUE(contents(folder / "state.h5") == before);
  EXPECT_FALSE(std::filesystem::exists(folder / "state.h5.partial"));
}

TEST(Hdf5Archive, AMissingFolderIsARunError) {
  const ScratchFolder folder;
  const auto path = folder / "missing/state.h5";
  EXPECT_EQ(message_of<RunError>([&] { Hdf5Writer(MPI_COMM_WORLD, path); }).find(path.string() + ": cannot write"), 0u);
}

// To close a file is collective: ranks that have opened it must not wait for the one that has not.
TEST(Hdf5Archive, AFileThatOneRankCannotOpenIsRefusedByAll) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");
  fails_to_open = rank_of(MPI_COMM_WORLD) == size_of(MPI_COMM_WORLD) - 1;
  EXPECT_THROW(Hdf5Reader(MPI_COMM_WORLD, folder / "state.h5"), DamagedFile);
  EXPECT_THROW(Hdf5Writer(MPI_COMM_WORLD, folder / "other.h5"), RunError);
  fails_to_open = false;
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_FALSE(std::filesystem::exists(folder / "other.h5.partial"));
  Hdf5Reader reader(MPI_COMM_WORLD, folder / "state.h5");
  expect_what_was_written(reader);
}

// A file may grow to 40 kB, as on a disk with that much room left; the room comes back when the writer has given up.
TEST(Hdf5Archive, AFullDiskIsARunErrorOnEveryRank) {
  const ScratchFolder folder;
  write_all(MPI_COMM_WORLD, folder / "state.h5");
  const std::string before = contents(folder / "state.h5");
  const auto ranks = static_cast<std::uint64_t>(size_of(MPI_COMM_WORLD));
  const auto rank = static_cast<std::uint64_t>(rank_of(MPI_COMM_WORLD));
  const std::vector<double> values(100000, 1.0);
  {
    Hdf5Writer writer(MPI_COMM_WORLD, folder / "state.h5");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    const rlimit tight{40000, old.rlim_max};
    setrlimit(RLIMIT_FSIZE, &tight);
    const std::string message = message_of<RunError>([&] {
      writer.write("big", std::span<const double>(values), ArrayBox{{ranks, 100000}, {rank, 0}, {1, 100000}});
    });
    setrlimit(RLIMIT_FSIZE, &old);
    EXPECT_NE(message.find("is the disk full"), std::string::npos) << message;
  }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_TRUE(contents(folder / "state.h5") == before);
  EXPECT_FALSE(std::filesystem::exists(folder / "state.h5.partial"));
}

}  // namespace
}  // namespace thalweg::io::hdf5_archive_test
