#include "loop/log.hpp"

#include "core/base/error.hpp"
#include "core/base/utf8.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace thalweg::loop {

void Log::copy_to(const std::string& path) {
  if (!prints_) return;
  file_.open(path, std::ios::app);
  if (!file_) throw RunError(fmt::format("The log {} cannot be written.", path));
  file_ << before_file_ << std::flush;
  before_file_.clear();
}

void Log::line(const std::string& text) {
  if (!prints_) return;
  std::fprintf(stdout, "%s\n", text.c_str());
  std::fflush(stdout);  // a pipe to tee or a batch system's file must not lag behind
  file_line(text);
}

void Log::file_line(const std::string& text) {
  if (!prints_) return;
  const std::string line = as_utf8(text) + '\n';
  if (file_.is_open())
    file_ << line << std::flush;
  else
    before_file_ += line;
}

}  // namespace thalweg::loop
