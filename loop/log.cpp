#include "loop/log.hpp"

#include "core/base/error.hpp"
#include "core/base/utf8.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <utility>

namespace thalweg::loop {

Log::~Log() {
  if (file_ >= 0) ::close(file_);
}

Log::Log(Log&& other) noexcept
    : prints_(other.prints_), file_(std::exchange(other.file_, -1)), kept_lines_(std::move(other.kept_lines_)) {}

Log& Log::operator=(Log&& other) noexcept {
  std::swap(prints_, other.prints_);
  std::swap(file_, other.file_);
  std::swap(kept_lines_, other.kept_lines_);
  return *this;
}

void Log::copy_to(const std::string& path) {
  if (!prints_) return;
  file_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw RunError(fmt::format("The log {} cannot be written.", path));
  write_kept_lines();
}

void Log::line(const std::string& text) {
  if (!prints_) return;
  std::fprintf(stdout, "%s\n", text.c_str());
  std::fflush(stdout);  // a pipe to tee or a batch system's file must not lag behind
  file_line(text);
}

void Log::file_line(const std::string& text) {
  if (!prints_) return;
  kept_lines_ += as_utf8(text) + '\n';
  if (file_ >= 0) write_kept_lines();
}

// What a full disk has no room for is tried again with the next line.
void Log::write_kept_lines() {
  while (!kept_lines_.empty()) {
    const ssize_t written = ::write(file_, kept_lines_.data(), kept_lines_.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    kept_lines_.erase(0, static_cast<std::size_t>(written));
  }
}

}  // namespace thalweg::loop
