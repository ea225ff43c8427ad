#include "io/diverted_file.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <string>
#include <system_error>

namespace thalweg::io {

void divert_to_memory(const std::filesystem::path& path) {
  struct stat given_up {};
  if (::stat(path.c_str(), &given_up) != 0) return;
  const int sink = ::memfd_create("given up", MFD_CLOEXEC);
  if (sink < 0) return;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const std::string name = entry.path().filename();
    int descriptor = -1;
    if (std::from_chars(name.data(), name.data() + name.size(), descriptor).ec != std::errc()) continue;
    struct stat open_file {};
    if (descriptor == sink || ::fstat(descriptor, &open_file) != 0) continue;
    if (open_file.st_dev == given_up.st_dev && open_file.st_ino == given_up.st_ino) ::dup2(sink, descriptor);
  }
  ::close(sink);
}

}  // namespace thalweg::io
