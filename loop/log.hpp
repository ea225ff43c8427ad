// Log: lines on standard output and, once a run folder exists, also in run.log.
#pragma once

#include <string>

namespace thalweg::loop {

class Log {
public:
  // prints: true on rank 0; the log of all other ranks does nothing.
  explicit Log(bool prints) : prints_(prints) {}
  ~Log();
  Log(Log&& other) noexcept;
  Log& operator=(Log&& other) noexcept;

  // Appends all lines, earlier ones included, to this file as well from now on. Throws RunError.
  void copy_to(const std::string& path);

  void line(const std::string& text);
  void file_line(const std::string& text);  // in the file only
  bool prints() const { return prints_; }

private:
  void write_kept_lines();

  bool prints_;
  int file_ = -1;           // its descriptor
  std::string kept_lines_;  // not yet in the file
};

}  // namespace thalweg::loop
