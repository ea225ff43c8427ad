// ParaView's list of the frames of a series with their times: a .pvd file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::io {

class PvdIndex {
public:
  struct Entry {
    double time;       // s
    std::string file;  // relative to the folder of the index
  };

  // continue_from: read an existing index and keep its entries up to that time (s). Empty: start with none.
  PvdIndex(std::filesystem::path path, std::optional<double> continue_from);

  // Adds a frame (in place of one of the same time) and rewrites the file in one atomic step. Throws RunError.
  // Called by one rank.
  void add(double time, const std::filesystem::path& file);

  const std::vector<Entry>& entries() const { return entries_; }

private:
  std::filesystem::path path_;
  std::vector<Entry> entries_;
};

}  // namespace thalweg::io
