#include "io/folder/folder_lock.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/interrupted_call.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <string_view>
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

std::string name_of_this_host() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return host.data();
}

constexpr std::string_view before_host = " on ";

// Holder of the lock, for a message to those who find it taken.
std::string name_of_this_process() {
  return fmt::format("process {}{}{}\n", ::getpid(), before_host, name_of_this_host());
}

// A lock on a network file system outlives a node that has crashed, until that node is started again. Empty where the
// holder is on this node.
std::string way_out(const std::string& holder, const std::filesystem::path& file) {
  const std::size_t at = holder.find(before_host);
  if (at == std::string::npos) return {};
  const std::string host = holder.substr(at + before_host.size());
  if (host == name_of_this_host()) return {};
  return fmt::format("; if {} is down and nothing can be writing from there, remove its lock: rm {}", host,
                     shell_word(file.string()));
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
  if (file_ < 0) {  // another user's, or the disk is full
    not_obtained_ = true;
    return;
  }
  if (takes_lock(file_)) {
    const std::string name = name_of_this_process();
    if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, name.data(), name.size(), 0) < 0) return;  // only a help
  } else if (errno == EWOULDBLOCK) {
    const std::string holder = first_line_of(file_);
    ::close(std::exchange(file_, -1));
    throw InputError(
        fmt::format("{}: a run is writing there now ({}); wait for its end, stop it with thalweg stop {}, "
                    "or choose another folder with --out{}.",
                    folder.string(), holder, shell_word(folder.string()), way_out(holder, folder / file_name)));
  } else {
    not_obtained_ = true;  // the file system has no locks
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

FolderLock::FolderLock(FolderLock&& other) noexcept
    : file_(std::exchange(other.file_, -1)), not_obtained_(std::exchange(other.not_obtained_, false)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(not_obtained_, other.not_obtained_);
  return *this;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace thalweg::io
