// Actions that a run may and may not take on a folder.
#include "io/folder/run_folder.hpp"
#include "core/base/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/folder/folder_lock.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace thalweg::io::run_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::contents;
using testing::message_of;
using testing::put;
using testing::ScratchFolder;

// The calls are one rank's, so the other ranks of the executable only look on.
class RunFolderTest : public ::testing::Test {
protected:
  void SetUp() override {
    if (rank_of(MPI_COMM_WORLD) != 0) GTEST_SKIP();
  }
  fs::path scratch(const std::string& name) {
    const fs::path path = fs::path("scratch") / ("run_folder_" + std::to_string(size_of(MPI_COMM_WORLD))) / name;
    fs::remove_all(path);
    fs::create_directories(path.parent_path());
    return path;
  }
};

TEST_F(RunFolderTest, AnExistingRunNeedsOverwriteAndIsOtherwiseUntouched) {
  const fs::path path = scratch("existing");
  const RunFolder folder(path);
  folder.create(false);
  folder.write_case("thalweg 0.1.0\nthalweg run case.yaml", "system: grains\n");
  put(folder.series(), "time [s]\n");
  put(folder.checkpoint(5), "state");
  put(path / "notes.txt", "mine");

  const std::string refused = message_of<InputError>([&] { folder.create(false); });
  EXPECT_EQ(refused, path.string() +
                         ": the folder holds a run already; choose another with --out, continue it with "
                         "--restart " +
                         path.string() + ", or replace it with --overwrite.");
  EXPECT_TRUE(fs::exists(folder.series()) && fs::exists(folder.checkpoint(5)));

  folder.create(true);
  EXPECT_FALSE(fs::exists(folder.series()) || fs::exists(folder.checkpoints()) || fs::exists(folder.case_file()));
  EXPECT_EQ(contents(path / "notes.txt"), "mine");
}

TEST_F(RunFolderTest, ARequestToStopTheRunThatBeginsOutlastsTheOldResults) {
  const RunFolder folder(scratch("asked"));
  folder.create(false);
  folder.write_case("thalweg 0.1.0", "system: grains\n");
  put(folder.stop(), "");
  folder.create(true);
  EXPECT_FALSE(fs::exists(folder.case_file()));
  EXPECT_TRUE(fs::exists(folder.stop()));
}

TEST_F(RunFolderTest, APlaceThatCannotBeWrittenIsRefusedBeforeAnythingIsMade) {
  const fs::path path = scratch("no_folder");
  put(path, "a file");
  EXPECT_EQ(message_of<InputError>([&] { RunFolder(path / "below" / "run").check_writable(); }),
            (path / "below" / "run").string() +
                ": cannot create the folder: Not a directory; choose another one with --out.");
  const fs::path run = scratch("not_yet") / "run";
  EXPECT_EQ(message_of<InputError>([&] { RunFolder(run).check_writable(); }), "");
  EXPECT_FALSE(fs::exists(run.parent_path()));
}

TEST_F(RunFolderTest, WhatIsNotARunIsNeverTouched) {
  const fs::path path = scratch("foreign");
  put(path / "case.yaml", "system: grains\n");  // a case somebody wrote, not the record of a run
  put(path / "series.csv", "precious");
  for (const bool overwrite : {false, true}) {
    const std::string message = message_of<InputError>([&] { RunFolder(path).create(overwrite); });
    EXPECT_NE(message.find("is not a run of Thalweg and is left alone; choose another folder with --out"),
              std::string::npos)
        << message;
  }
  EXPECT_EQ(contents(path / "series.csv"), "precious");
  EXPECT_NE(
      message_of<InputError>([&] { RunFolder(path / "series.csv").create(true); }).find("there is a file of this name"),
      std::string::npos);
}

TEST_F(RunFolderTest, AnEmptyOrMissingFolderIsFine) {
  const fs::path path = scratch("new");
  RunFolder(path / "deep").check_new(false);
  EXPECT_FALSE(fs::exists(path));
  RunFolder(path / "deep").create(false);
  EXPECT_TRUE(fs::is_directory(path / "deep"));
  RunFolder(path / "deep").create(false);
  // Of a run that was killed at once, and of one that replaced another and was killed before its own case was there.
  for (const char* name : {"case.yaml.partial", "bed.h5.partial", "summary.json.partial.123"})
    put(path / "deep" / name, "# Thal");
  RunFolder(path / "deep").create(false);
  EXPECT_TRUE(fs::is_empty(path / "deep"));
}

TEST_F(RunFolderTest, ALockThatCannotBeObtainedKeepsNobodyOut) {
  const fs::path path = scratch("unlocked");
  fs::create_directories(path / FolderLock::file_name);  // nobody can open it as a file
  EXPECT_FALSE(FolderLock(path).keeps_others_out());
  EXPECT_TRUE(FolderLock(scratch("locked")).keeps_others_out());
}

TEST_F(RunFolderTest, TheCaseBeginsWithItsMarkerAndComments) {
  const fs::path path = scratch("case");
  const RunFolder folder(path);
  folder.create(false);
  EXPECT_FALSE(folder.is_run_folder());
  folder.write_case("version 1\ncommand", "system: grains\n");
  EXPECT_TRUE(folder.is_run_folder());
  EXPECT_EQ(contents(folder.case_file()),
            "# Thalweg run: this is the case as it was run, with every default filled in.\n"
            "# version 1\n# command\nsystem: grains\n");
}

TEST_F(RunFolderTest, RotationKeepsTheNewestAndNamesTheLatest) {
  const fs::path path = scratch("rotation");
  const RunFolder folder(path);
  folder.create(false);
  put(folder.checkpoints() / "mine.h5", "left alone");
  for (const std::int64_t step : {900, 1000, 1100}) {
    put(folder.checkpoint(step), "state");
    folder.rotate_checkpoints(step, 2);
  }
  EXPECT_FALSE(fs::exists(folder.checkpoint(900)));
  EXPECT_TRUE(fs::exists(folder.checkpoint(1000)) && fs::exists(folder.checkpoint(1100)));
  EXPECT_EQ(folder.latest_checkpoint(), folder.checkpoint(1100));
  EXPECT_EQ(checkpoint_at(path), folder.checkpoint(1100));
  EXPECT_EQ(checkpoint_at(folder.checkpoint(1000)), folder.checkpoint(1000));

  // A restart from step 1000 that has come to 1050: 1100 is of a run that never was.
  put(folder.checkpoint(1050), "state");
  folder.rotate_checkpoints(1050, 2);
  EXPECT_FALSE(fs::exists(folder.checkpoint(1100)));
  EXPECT_TRUE(fs::exists(folder.checkpoint(1000)) && fs::exists(folder.checkpoint(1050)));
  EXPECT_EQ(folder.latest_checkpoint(), folder.checkpoint(1050));
  EXPECT_TRUE(fs::exists(folder.checkpoints() / "mine.h5"));

  // Remains of killed runs go with the next checkpoint.
  put(folder.checkpoints() / "step_1070.h5.partial", "half a state");
  put(folder.checkpoints() / "latest.partial", "step_10");
  folder.rotate_checkpoints(1050, 2);
  EXPECT_FALSE(fs::exists(folder.checkpoints() / "step_1070.h5.partial"));
  EXPECT_FALSE(fs::exists(folder.checkpoints() / "latest.partial"));

  // The latest need not be known.
  const std::vector<fs::path> newest_first{folder.checkpoint(1050), folder.checkpoint(1000)};
  EXPECT_EQ(folder.checkpoints_to_try(), newest_first);
  for (const char* text : {"", "step_", "step_990.h5\n", "../step_1000.h5\n"}) {
    put(folder.checkpoints() / "latest", text);
    EXPECT_EQ(folder.checkpoints_to_try(), newest_first) << text;
  }
  put(folder.checkpoints() / "latest", "step_1000.h5\n");
  EXPECT_EQ(folder.latest_checkpoint(), folder.checkpoint(1000));
  fs::remove(folder.checkpoints() / "latest");
  EXPECT_EQ(folder.checkpoints_to_try(), newest_first);
  EXPECT_NE(message_of<InputError>([&] { checkpoint_at(scratch("nowhere")); }).find("there is no such file or folder"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { checkpoint_at(path.parent_path()); }).find("has no checkpoint"),
            std::string::npos);
}

// A run that came to step 1100 and is taken up again at 1000: until it has a checkpoint of its own, that is its latest,
// and those of the course that is left come last.
TEST_F(RunFolderTest, ARestartFromAnEarlierCheckpointIsKnownAtOnce) {
  const RunFolder folder(scratch("branch"));
  folder.create(false);
  folder.write_case("", "system: grains\n");
  for (const std::int64_t step : {900, 1000, 1100}) {
    put(folder.checkpoint(step), "state");
    folder.rotate_checkpoints(step, 3);
  }
  folder.keep_case(1100);  // of an earlier restart there
  folder.keep_case(1000);
  folder.go_on_from(1000);
  folder.write_case("", "system: fluid\n");
  EXPECT_EQ(folder.checkpoints_to_try(),
            (std::vector<fs::path>{folder.checkpoint(1000), folder.checkpoint(900), folder.checkpoint(1100)}));
  EXPECT_EQ(folder.case_of(folder.checkpoint(1000)).filename(), "case_until_step_1000.yaml");
  // With the first checkpoint of the new course the other one is gone.
  put(folder.checkpoint(1050), "state");
  folder.rotate_checkpoints(1050, 3);
  EXPECT_FALSE(fs::exists(folder.checkpoint(1100)) || fs::exists(folder.path() / "case_until_step_1100.yaml"));
  EXPECT_TRUE(fs::exists(folder.path() / "case_until_step_1000.yaml"));
  EXPECT_EQ(folder.case_of(folder.checkpoint(1050)), folder.case_file());
  folder.go_on_from(1070);  // from another folder's checkpoint
  EXPECT_EQ(folder.latest_checkpoint(), folder.checkpoint(1050));
}

// A run that came to step 1100 is taken up again there with another case, is killed before its next checkpoint, and is
// then taken up again at 1000, which was computed with the first case.
TEST_F(RunFolderTest, TheCaseThatIsKeptIsTheOneThatComputedTheCheckpoint) {
  const RunFolder folder(scratch("two_restarts"));
  folder.create(false);
  folder.write_case("", "system: grains\n");
  const std::string first = contents(folder.case_file());
  for (const std::int64_t step : {1000, 1100}) {
    put(folder.checkpoint(step), "state");
    folder.rotate_checkpoints(step, 3);
  }
  folder.keep_case(1100);
  folder.write_case("", "system: fluid\n");
  folder.keep_case(1000);
  folder.write_case("", "system: resolved\n");
  for (const std::int64_t step : {1000, 1100}) {
    EXPECT_EQ(folder.case_of(folder.checkpoint(step)).filename(), "case_until_step_" + std::to_string(step) + ".yaml");
    EXPECT_EQ(contents(folder.case_of(folder.checkpoint(step))), first) << step;
  }
}

// A checkpoint computed anew is of the present case, also where one of the same step was the end of another case.
TEST_F(RunFolderTest, ACheckpointComputedAnewIsOfThePresentCase) {
  const RunFolder folder(scratch("anew"));
  folder.create(false);
  folder.write_case("", "system: grains\n");
  for (const std::int64_t step : {1000, 1100}) {
    put(folder.checkpoint(step), "state");
    folder.rotate_checkpoints(step, 3);
  }
  folder.keep_case(1100);
  folder.go_on_from(1100);
  folder.write_case("", "system: fluid\n");
  folder.rotate_checkpoints(1100, 3);  // stopped before the first step
  EXPECT_EQ(folder.case_of(folder.checkpoint(1100)).filename(), "case_until_step_1100.yaml");
  folder.keep_case(1000);
  folder.go_on_from(1000);
  folder.write_case("", "system: resolved\n");
  folder.rotate_checkpoints(1100, 3);
  EXPECT_EQ(folder.case_of(folder.checkpoint(1100)), folder.case_file());
  EXPECT_EQ(folder.case_of(folder.checkpoint(1000)).filename(), "case_until_step_1000.yaml");
}

TEST_F(RunFolderTest, RoomIsTakenByWritingWhereItCannotBePromised) {
  const fs::path path = scratch("room");
  put(path, "kept");
  EXPECT_TRUE(fill_with_zeros(path, 4, 5'000'000));
  EXPECT_EQ(fs::file_size(path), 5'000'004u);
  EXPECT_TRUE(contents(path).starts_with(std::string("kept\0\0", 6)));
  EXPECT_FALSE(fill_with_zeros("/dev/full", 0, 10));
  EXPECT_FALSE(fill_with_zeros(path / "missing", 0, 10));
}

TEST_F(RunFolderTest, ASecondRunIsKeptOut) {
  const fs::path path = scratch("locked");
  EXPECT_EQ(FolderLock::is_held(path), std::nullopt);
  {
    const FolderLock mine(path);
    EXPECT_EQ(FolderLock::is_held(path), std::optional(true));
    const std::string message = message_of<InputError>([&] { FolderLock second(path); });
    EXPECT_NE(message.find("a run is writing there now (process "), std::string::npos) << message;
    EXPECT_EQ(message.find("rm "), std::string::npos) << message;  // whoever holds it is here
    put(path / FolderLock::file_name, "process 17 on node-that-is-down\n");
    EXPECT_NE(message_of<InputError>([&] { FolderLock second(path); })
                  .find("choose another folder with --out; if node-that-is-down is down and nothing can be writing "
                        "from there, remove its lock: rm " +
                        (path / FolderLock::file_name).string() + "."),
              std::string::npos);
    FolderLock moved;
    moved = FolderLock(path.parent_path());
    EXPECT_THROW(FolderLock(path.parent_path()), InputError);
  }
  EXPECT_EQ(FolderLock::is_held(path), std::optional(false));
  EXPECT_TRUE(FolderLock{path}.keeps_others_out());
  fs::remove(path.parent_path() / FolderLock::file_name);
  RunFolder(path).create(false);  // the lock makes it no folder that holds something
}

}  // namespace
}  // namespace thalweg::io::run_folder_test
