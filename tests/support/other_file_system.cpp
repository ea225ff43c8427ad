// A file system as clusters have it, for programs that are started with this library in LD_PRELOAD.
//
// BLIND_TO=FOLDER: all ranks but the first find nothing below this folder, or at a relative path, when they look for it
// by name: as on nodes whose cache of a network file system is old. HDF5 files, which ranks open together, are there.
// WITHOUT_LOCKS=1: flock() fails, as on Lustre that is mounted without it.
#include <dirent.h>
#include <dlfcn.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

bool is_blind_to(const char* path) {
  const char* folder = std::getenv("BLIND_TO");
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  if (rank == nullptr) rank = std::getenv("PMI_RANK");
  if (path == nullptr || folder == nullptr || rank == nullptr || std::strcmp(rank, "0") == 0) return false;
  const std::string_view name(path);
  return (name.starts_with(folder) || !name.starts_with('/')) && name.find(".h5") == std::string_view::npos;
}

template <typename Function>
Function* next(const char* name, Function*) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int not_there() {
  errno = ENOENT;
  return -1;
}

}  // namespace

extern "C" {

FILE* fopen(const char* path, const char* mode) {
  if (is_blind_to(path)) return not_there(), nullptr;
  return next("fopen", &fopen)(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (is_blind_to(path)) return not_there(), nullptr;
  return next("fopen64", &fopen64)(path, mode);
}

DIR* opendir(const char* path) {
  if (is_blind_to(path)) return not_there(), nullptr;
  return next("opendir", &opendir)(path);
}

int stat(const char* path, struct stat* found) {
  return is_blind_to(path) ? not_there()
                           : next("stat", static_cast<int (*)(const char*, struct stat*)>(nullptr))(path, found);
}

int flock(int file, int operation) {
  if (std::getenv("WITHOUT_LOCKS") != nullptr) {
    errno = ENOLCK;
    return -1;
  }
  return next("flock", &flock)(file, operation);
}
}
