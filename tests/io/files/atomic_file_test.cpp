// Room on the disk for a file, while signals arrive; files and folders that cannot be read.
#include "io/files/atomic_file.hpp"
#include "core/base/error.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <vector>

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

TEST(AtomicFile, AFileThatCannotBeReadIsNotAnEmptyOne) {
  const testing::ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const std::string long_text(200000, 'a');
  testing::put(folder / "file", long_text);
  testing::put(folder / "empty", "");
  EXPECT_EQ(read_text(folder / "file"), long_text);
  EXPECT_EQ(read_text(folder / "empty"), "");
  EXPECT_THROW(read_text(folder / "missing"), InputError);
  EXPECT_THROW(read_text(folder.path()), InputError);
  EXPECT_THROW(read_text("/proc/self/mem"), InputError);  // its first read fails, as of a bad disk
}

TEST(AtomicFile, NothingIsLeftOfATextThatCannotBeWritten) {
  const testing::ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  make_folder(folder / "taken");
  EXPECT_THROW(write_text_atomically(folder / "taken", "text"), RunError);
  EXPECT_THROW(write_text_durably(folder / "taken", "text"), RunError);
  EXPECT_EQ(entries_of(folder.path()), std::vector<std::filesystem::path>{folder / "taken"});
  write_text_atomically(folder / "text", "text");
  write_text_durably(folder / "text", "another");
  EXPECT_EQ(testing::contents(folder / "text"), "another");
  EXPECT_EQ(entries_of(folder.path()).size(), 2u);
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
