#include "io/files/atomic_file.hpp"

#include "core/base/error.hpp"
#include "io/files/interrupted_call.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

namespace thalweg::io {

namespace {

// Throws the error of the last call, which could not write the file; what is left of it on a full disk goes first, as
// other files need the room.
[[noreturn]] void give_up(const std::filesystem::path& path, const std::filesystem::path& partial) {
  const RunError error(fmt::format("{}: cannot write the file: {}.", path.string(), std::strerror(errno)));
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  throw error;
}

// Writes the text under a name (path + ending) until it is renamed, and returns this name.
std::filesystem::path write_partial(const std::filesystem::path& path, const std::string& ending,
                                    const std::string& text) {
  std::filesystem::path partial = path;
  partial += ending;
  std::ofstream file(partial, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) give_up(path, partial);
  return partial;
}

// fsync() of a file or a folder; some file systems refuse it for a folder.
bool sync(const std::filesystem::path& path) {
  const int file = opened(path, O_RDONLY);
  if (file < 0) return false;
  const bool synced =
      repeated_if_interrupted([&] { return ::fsync(file); }) == 0 || errno == EINVAL || errno == ENOTSUP;
  ::close(file);
  return synced;
}

// The error of a file that the last call could not open or read.
InputError cannot_read(const std::filesystem::path& path) {
  if (errno == ENOENT || errno == ENOTDIR)
    return InputError(fmt::format("{}: there is no such file; check the path.", path.string()));
  return InputError(fmt::format("{}: cannot read the file: {}.", path.string(), std::strerror(errno)));
}

}  // namespace

void write_text_atomically(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path partial = write_partial(path, fmt::format(".partial.{}", ::getpid()), text);
  if (std::rename(partial.c_str(), path.c_str()) != 0) give_up(path, partial);
}

void write_text_durably(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path partial = write_partial(path, ".partial", text);
  if (!put_on_disk(partial, path)) give_up(path, partial);
}

bool put_on_disk(const std::filesystem::path& path) { return sync(path); }

bool put_on_disk(const std::filesystem::path& from, const std::filesystem::path& to) {
  return sync(from) && std::rename(from.c_str(), to.c_str()) == 0 && sync(std::filesystem::absolute(to).parent_path());
}

bool is_left_by_a_kill(const std::filesystem::path& path) {
  return path.filename().string().find(".partial") != std::string::npos;
}

bool create_file(const std::filesystem::path& path) {
  const int file = opened(path, O_CREAT | O_TRUNC | O_WRONLY);
  if (file < 0) return false;
  ::close(file);
  return true;
}

bool can_create(const std::filesystem::path& path) { return create_file(path) && std::remove(path.c_str()) == 0; }

bool reserve_on_disk(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t bytes,
                     std::uint64_t written_to) {
  const int file = opened(path, O_RDWR);
  if (file < 0) return false;
  const int reserved = repeated_if_interrupted(
      [&] { return ::fallocate(file, 0, static_cast<off_t>(offset), static_cast<off_t>(bytes)); });
  const int error = reserved == 0 ? 0 : errno;
  ::close(file);
  if (error != EOPNOTSUPP && error != ENOSYS) return error == 0;
  const std::uint64_t from = std::max(offset, written_to), to = offset + bytes;
  return from >= to || fill_with_zeros(path, from, to - from);
}

bool fill_with_zeros(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t bytes) {
  const int file = opened(path, O_WRONLY);
  if (file < 0) return false;
  const std::vector<char> zeros(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, std::uint64_t{1} << 22)), 0);
  bool good = true;
  while (good && bytes > 0) {
    const ssize_t done = repeated_if_interrupted([&] {
      return ::pwrite(file, zeros.data(), std::min<std::uint64_t>(bytes, zeros.size()), static_cast<off_t>(offset));
    });
    good = done > 0;
    if (good) offset += static_cast<std::uint64_t>(done), bytes -= static_cast<std::uint64_t>(done);
  }
  good = good && repeated_if_interrupted([&] { return ::fdatasync(file); }) == 0;
  return (::close(file) == 0 || errno == EINTR) && good;
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::vector<std::filesystem::path> changed;
  for (auto missing = std::filesystem::absolute(path); !std::filesystem::exists(missing, error);
       missing = missing.parent_path())
    changed.push_back(missing.parent_path());
  std::filesystem::create_directories(path, error);
  if (error) throw RunError(fmt::format("{}: cannot create the folder: {}.", path.string(), error.message()));
  for (const auto& folder : changed) sync(folder);  // one that cannot be read cannot be waited for
}

std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> found;
  std::filesystem::directory_iterator entry(folder, error);
  if (error == std::errc::no_such_file_or_directory) return {};
  for (const std::filesystem::directory_iterator end; !error && entry != end; entry.increment(error))
    found.push_back(entry->path());
  if (error) throw RunError(fmt::format("{}: cannot list the folder: {}.", folder.string(), error.message()));
  return found;
}

void remove_entry(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) throw RunError(fmt::format("{}: cannot remove: {}.", path.string(), error.message()));
}

void check_readable(const std::filesystem::path& path) {
  const int file = opened(path, O_RDONLY);
  if (file < 0) throw cannot_read(path);
  ::close(file);
}

std::string read_text(const std::filesystem::path& path) {
  const int file = opened(path, O_RDONLY);
  if (file < 0) throw cannot_read(path);
  std::string text, piece(std::size_t{1} << 16, '\0');
  ssize_t length = 0;
  while ((length = repeated_if_interrupted([&] { return ::read(file, piece.data(), piece.size()); })) > 0)
    text.append(piece, 0, static_cast<std::size_t>(length));
  const int error = errno;
  ::close(file);
  errno = error;
  if (length < 0) throw cannot_read(path);
  return text;
}

}  // namespace thalweg::io
