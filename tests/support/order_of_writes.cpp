// A library to preload: it says in the file $ORDER_OF_WRITES, in their order, what a program puts on the disk (fsync)
// and which names it gives (rename).
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

void say(const char* what, const char* path) {
  const char* log = std::getenv("ORDER_OF_WRITES");
  const int file = log ? open(log, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666) : -1;
  if (file < 0) return;
  char line[8192];
  const int size = std::snprintf(line, sizeof line, "%s %s\n", what, path);
  if (write(file, line, static_cast<std::size_t>(size)) != size) std::abort();
  close(file);
}

template <typename Function>
Function* own(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" int fsync(int file) {
  char path[4096];
  const ssize_t size = readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, sizeof path - 1);
  path[size < 0 ? 0 : size] = '\0';
  const int result = own<int(int)>("fsync")(file);
  if (result == 0) say("fsync", path);
  return result;
}

extern "C" int rename(const char* from, const char* to) noexcept {
  const int result = own<int(const char*, const char*)>("rename")(from, to);
  char whole[4096];
  if (result == 0) say("rename", realpath(to, whole) != nullptr ? whole : to);
  return result;
}
