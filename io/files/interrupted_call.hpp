// System calls that a signal has interrupted, once more.
//
// SA_RESTART restarts only some calls by itself: fallocate() on tmpfs fails with EINTR while a signal is pending, and
// so may others on a file system over the network.
#pragma once

#include <fcntl.h>

#include <cerrno>
#include <filesystem>

namespace thalweg::io {

// The result of a call that returns -1 and sets errno where it fails, repeated until it is not EINTR. Not for close(),
// which has closed the file all the same.
template <typename Call>
auto repeated_if_interrupted(Call&& call) {
  auto result = call();
  while (result == -1 && errno == EINTR) result = call();
  return result;
}

// A file opened with these flags, and closed in processes that are started; -1 if that fails.
inline int opened(const std::filesystem::path& path, int flags) {
  return repeated_if_interrupted([&] { return ::open(path.c_str(), flags | O_CLOEXEC, 0666); });
}

}  // namespace thalweg::io
