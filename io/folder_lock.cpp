#include "io/folder_lock.hpp"

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/interrupted_call.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

namespace thalweg::io {
namespace {

// A run that has just been killed may still be going down.
constexpr int most_attempts = 30;
constexpr std::chrono::milliseconds between_attempts(100);

bool takes_lock(int file) {
  for (int attempt = 1;; ++attempt) {
    if (repeated_if_interrupted([&] { return ::flock(file, LOCK_EX | LOCK_NB); }) == 0) return true;
    if (errno != EWOULDBLOCK || attempt == most_attempts) return false;
    std::this_thread::sleep_for(between_attempts);
  }
}

// Who holds the lock, for somebody who finds it taken.
std::string name_of_this_process() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}\n", ::getpid(), host.data());
}

std::string first_line_of(int file) {
  std::array<char, 300> text{};
  const ssize_t length = ::pread(file, text.data(), text.size(), 0);
  const std::string all(text.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  return all.substr(0, all.find('\n'));
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  make_folder(folder);
  file_ = opened(folder / file_name, O_RDWR | O_CREAT);
  if (file_ < 0) return;  // whoever cannot write there is told so when the run begins to
  if (takes_lock(file_)) {
    const std::string name = name_of_this_process();
    if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, name.data(), name.size(), 0) < 0) return;  // only a help
  } else if (errno == EWOULDBLOCK) {
    const std::string holder = first_line_of(file_);
    ::close(std::exchange(file_, -1));
    throw InputError(
        fmt::format("{}: a run is writing there now ({}); wait for its end, stop it with thalweg stop {}, "
                    "or choose another folder with --out.",
                    folder.string(), holder, folder.string()));
  }
}

std::optional<bool> FolderLock::is_held(const std::filesystem::path& folder) {
  const int file = opened(folder / file_name, O_RDWR);
  if (file < 0) return {};
  std::optional<bool> held;
  if (repeated_if_interrupted([&] { return ::flock(file, LOCK_EX | LOCK_NB); }) == 0)
    held = false;
  else if (errno == EWOULDBLOCK)
    held = true;
  ::close(file);
  return held;
}

FolderLock::FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace thalweg::io
