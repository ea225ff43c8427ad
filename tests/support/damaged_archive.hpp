// What becomes of a checkpoint that loses rows, and what a test asks of those who read it: they refuse it, or lose
// nothing by it.
#pragma once

#include "core/base/error.hpp"
#include "tests/support/memory_archive.hpp"

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace thalweg::test {

struct Loss {
  std::string what;  // "the last row of grains/radius"
  MemoryArchive left;
};

// Every dataset in turn without its last row, without any, and not there at all.
inline std::vector<Loss> losses_of(const MemoryArchive& whole) {
  std::vector<Loss> losses;
  const auto add = [&](const std::string& path, const char* what, std::uint64_t rows) {
    losses.push_back({what + (" of " + path), whole});
    MemoryArchive::Dataset& dataset = losses.back().left.datasets.at(path);
    const std::uint64_t before = dataset.shape[0];
    dataset.shape[0] = rows;
    dataset.is_whole = false;
    std::visit([&](auto& values) { values.resize(values.size() / before * rows); }, dataset.values);
  };
  for (const auto& [path, dataset] : whole.datasets) {
    losses.push_back({"all of " + path, whole});
    losses.back().left.datasets.erase(path);
    if (dataset.shape[0] == 0) continue;
    add(path, "the rows", 0);
    if (dataset.shape[0] > 1) add(path, "the last row", dataset.shape[0] - 1);
  }
  return losses;
}

// True if loading refuses an archive, as a checkpoint that is damaged or of another case.
inline bool is_refused(const MemoryArchive& archive, const std::function<void(MemoryReader&)>& load) {
  MemoryReader reader(archive);
  try {
    load(reader);
  } catch (const InputError&) {
    return true;
  } catch (const std::logic_error&) {  // a reader of checkpoints makes it that
    return true;
  }
  return false;
}

}  // namespace thalweg::test
