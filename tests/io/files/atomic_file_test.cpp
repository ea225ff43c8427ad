// Room on the disk for a file, while signals arrive; folders that cannot be listed.
#include "io/files/atomic_file.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

static int interruptions = 0;

// The call of the system, but for the first ones, which fail as on tmpfs while a signal is pending.
extern "C" int fallocate(int file, int mode, off_t offset, off_t length) {
  if (interruptions == 0) return static_cast<int>(::syscall(SYS_fallocate, file, mode, offset, length));
  --interruptions;
  errno = EINTR;
  return -1;
}

namespace thalweg::io::atomic_file_test {
namespace {

TEST(AtomicFile, ASignalDoesNotMakeTheDiskFull) {
  const testing::ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const std::filesystem::path path = folder / "room";
  testing::put(path, "kept");
  interruptions = 3;
  EXPECT_TRUE(reserve_on_disk(path, 4, 5000));
  EXPECT_EQ(interruptions, 0);
  EXPECT_EQ(std::filesystem::file_size(path), 5004u);
  EXPECT_TRUE(testing::contents(path).starts_with("kept"));
}

TEST(AtomicFile, AFolderThatCannotBeListedIsNotAnEmptyOne) {
  const testing::ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  EXPECT_TRUE(entries_of(folder / "missing").empty());
  testing::put(folder / "file", "no folder");
  EXPECT_THROW(entries_of(folder / "file"), RunError);
}

TEST(AtomicFile, WhatIsRemovedIsGoneOrTheReasonIsSaid) {
  const testing::ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  testing::put(folder / "file", "a");
  make_folder(folder / "parts");
  testing::put(folder / "parts" / "one", "b");
  for (const char* name : {"file", "parts", "missing"}) {
    remove_entry(folder / name);
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  }
  EXPECT_THROW(remove_entry("/proc/self/status"), RunError);
}

}  // namespace
}  // namespace thalweg::io::atomic_file_test
