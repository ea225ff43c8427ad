// The log of a run whose disk is full for a while.
#include "loop/log.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>

namespace thalweg::loop::log_test {
namespace {

TEST(Log, GoesOnOnceThereIsRoomAgain) {
  const testing::ScratchFolder folder;
  const auto path = folder / "run.log";
  testing::put(path, std::string(1000, '.') + '\n');
  Log log(true);
  log.file_line("before the folder");
  log.copy_to(path.string());
  const std::string before = testing::contents(path);
  EXPECT_TRUE(before.ends_with("\nbefore the folder\n"));
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit full{before.size(), old.rlim_max};  // no file may grow beyond the log as it is
  setrlimit(RLIMIT_FSIZE, &full);
  log.file_line("on a full disk");
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_EQ(testing::contents(path), before);
  log.file_line("after it");
  EXPECT_EQ(testing::contents(path), before + "on a full disk\nafter it\n");
}

}  // namespace
}  // namespace thalweg::loop::log_test
