// What the program tells its user: lines on standard output and, once a run folder exists, the same lines in run.log.
#pragma once

#include <fstream>
#include <string>

namespace thalweg::driver {

class Log {
public:
  // speaking: true on rank 0; all other ranks keep silent.
  explicit Log(bool speaking) : speaking_(speaking) {}

  // From now on every line goes to this file as well (appended), also those said before.
  void copy_to(const std::string& path);

  void line(const std::string& text);
  bool speaking() const { return speaking_; }

private:
  bool speaking_;
  std::string said_before_file_;
  std::ofstream file_;
};

}  // namespace thalweg::driver
