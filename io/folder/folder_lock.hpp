// Keeps a second run out of a run folder.
#pragma once

#include <filesystem>
#include <optional>

namespace thalweg::io {

// Holds a lock on the file .lock of the folder from its construction on. The system releases it with the process,
// however that ends, so that the file may stay.
class FolderLock {
public:
  FolderLock() = default;  // holds nothing

  // Makes the folder where it is missing. Throws InputError where another process holds its lock for three seconds and
  // more, and RunError where the folder cannot be made.
  explicit FolderLock(const std::filesystem::path& folder);

  // False where a lock was asked for and not obtained: the file cannot be opened, or the file system has no locks.
  bool keeps_others_out() const { return !not_obtained_; }

  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

  // True if any process, this one included, holds the lock of the folder now; nothing if that cannot be determined:
  // there is no lock file, it is not this user's, or the file system has no locks.
  static std::optional<bool> is_held(const std::filesystem::path& folder);

  static constexpr const char* file_name = ".lock";

private:
  int file_ = -1;
  bool not_obtained_ = false;
};

}  // namespace thalweg::io
