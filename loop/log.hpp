// Log: lines on standard output and, once a run folder exists, also in run.log.
#pragma once

#include <fstream>
#include <string>

namespace thalweg::loop {

class Log {
public:
  // prints: true on rank 0; the log of all other ranks does nothing.
  explicit Log(bool prints) : prints_(prints) {}

  // Appends all lines, earlier ones included, to this file as well from now on. Throws RunError.
  void copy_to(const std::string& path);

  void line(const std::string& text);
  void file_line(const std::string& text);  // in the file only
  bool prints() const { return prints_; }

private:
  bool prints_;
  std::string before_file_;
  std::ofstream file_;
};

}  // namespace thalweg::loop
