// An archive in memory for tests: every rank of the writing communicator keeps the whole of every dataset, so that it
// can be read back on any other communicator, and compared bit by bit with the archive of a run on other ranks.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/damaged_file.hpp"
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <variant>

namespace thalweg::test {

struct MemoryArchive {
  using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>>;
  struct Dataset {
    std::vector<std::uint64_t> shape;
    Values values;
    bool is_whole = true;  // false: a file would tell by the checksum that some are missing, unless all are
  };
  std::map<std::string, Dataset> datasets;
  std::map<std::string, std::variant<double, std::int64_t, std::string>> attributes;
};

// Calls visit(index in the box, index in the whole) for every value of a box, in order.
template <typename Visitor>
void for_each_value(const ArrayBox& box, Visitor&& visit) {
  std::size_t count = 1;
  for (const auto n : box.shape) count *= n;
  for (std::size_t local = 0; local < count; ++local) {
    std::size_t rest = local, global = 0, stride = 1;
    for (std::size_t d = box.shape.size(); d-- > 0;) {
      global += (box.offset[d] + rest % box.shape[d]) * stride;
      rest /= box.shape[d];
      stride *= box.global_shape[d];
    }
    visit(local, global);
  }
}

// Empty if the archives hold the same bits; otherwise the path of the first difference.
inline std::string first_difference(const MemoryArchive& a, const MemoryArchive& b) {
  if (a.attributes != b.attributes) return "attributes";
  if (a.datasets.size() != b.datasets.size()) return "number of datasets";
  for (const auto& [path, mine] : a.datasets) {
    const auto other = b.datasets.find(path);
    if (other == b.datasets.end() || other->second.shape != mine.shape) return path + " (shape)";
    if (other->second.values.index() != mine.values.index()) return path + " (type)";
    const bool same = std::visit(
        [&](const auto& values) {
          const auto& theirs = std::get<std::decay_t<decltype(values)>>(other->second.values);
          return values.size() == theirs.size() &&
                 (values.empty() || std::memcmp(values.data(), theirs.data(), values.size() * sizeof(values[0])) == 0);
        },
        mine.values);
    if (!same) return path;
  }
  return {};
}

class MemoryWriter : public ArchiveWriter {
public:
  MemoryWriter(MemoryArchive& archive, MPI_Comm communicator) : archive_(archive), communicator_(communicator) {}

  void write(const std::string& path, std::span<const double> v, const ArrayBox& box) override { put(path, v, box); }
  void write(const std::string& path, std::span<const float> v, const ArrayBox& box) override { put(path, v, box); }
  void write(const std::string& path, std::span<const std::int64_t> v, const ArrayBox& box) override {
    put(path, v, box);
  }
  void attribute(const std::string& path, double value) override { archive_.attributes[path] = value; }
  void attribute(const std::string& path, std::int64_t value) override { archive_.attributes[path] = value; }
  void attribute(const std::string& path, const std::string& value) override { archive_.attributes[path] = value; }

private:
  template <typename T>
  void put(const std::string& path, std::span<const T> values, const ArrayBox& box) {
    struct Placed {
      std::uint64_t where;
      T value;
    };
    std::vector<Placed> rows;
    std::vector<int> to;
    const int ranks = size_of(communicator_);
    for (int rank = 0; rank < ranks; ++rank)
      for_each_value(box, [&](std::size_t local, std::size_t global) {
        rows.push_back({global, values[local]});
        to.push_back(rank);
      });
    std::size_t size = 1;
    for (const auto n : box.global_shape) size *= n;
    std::vector<T> all(size);
    const std::vector<Placed> arrived = exchange_rows(communicator_, rows, to);
    // Every value must come from exactly one rank.
    if (arrived.size() != size)
      throw RunError(fmt::format("{}: {} values were written into {}.", path, arrived.size(), size));
    for (const Placed& p : arrived) all[p.where] = p.value;
    archive_.datasets[path] = {box.global_shape, std::move(all), true};
  }

  MemoryArchive& archive_;
  MPI_Comm communicator_;
};

// What save(ArchiveWriter&, how ...) of a state saves. Collective.
template <typename State, typename... How>
MemoryArchive saved(const State& state, MPI_Comm communicator, const How&... how) {
  MemoryArchive archive;
  MemoryWriter writer(archive, communicator);
  state.save(writer, how...);
  return archive;
}

class MemoryReader : public ArchiveReader {
public:
  explicit MemoryReader(const MemoryArchive& archive) : archive_(archive) {}

  bool has(const std::string& path) const override {
    return archive_.datasets.count(path) > 0 || archive_.attributes.count(path) > 0;
  }
  std::vector<std::uint64_t> shape(const std::string& path) const override { return dataset(path).shape; }
  void read(const std::string& path, std::span<double> v, const ArrayBox& box) override { take(path, v, box); }
  void read(const std::string& path, std::span<float> v, const ArrayBox& box) override { take(path, v, box); }
  void read(const std::string& path, std::span<std::int64_t> v, const ArrayBox& box) override { take(path, v, box); }
  double real_attribute(const std::string& path) const override { return attribute<double>(path); }
  std::int64_t integer_attribute(const std::string& path) const override { return attribute<std::int64_t>(path); }
  std::string text_attribute(const std::string& path) const override { return attribute<std::string>(path); }

private:
  const MemoryArchive::Dataset& dataset(const std::string& path) const {
    const auto found = archive_.datasets.find(path);
    if (found == archive_.datasets.end()) throw InputError("The archive in memory has no dataset " + path + ".");
    return found->second;
  }
  template <typename T>
  T attribute(const std::string& path) const {
    const auto found = archive_.attributes.find(path);
    if (found == archive_.attributes.end() || !std::holds_alternative<T>(found->second))
      throw InputError("The archive in memory has no such attribute " + path + ".");
    return std::get<T>(found->second);
  }
  template <typename T>
  void take(const std::string& path, std::span<T> values, const ArrayBox& box) {
    const MemoryArchive::Dataset& d = dataset(path);
    if (d.shape != box.global_shape || !std::holds_alternative<std::vector<T>>(d.values))
      throw InputError("The archive in memory has another shape or type of " + path + ".");
    const auto& all = std::get<std::vector<T>>(d.values);
    if (!d.is_whole && !all.empty()) throw DamagedFile("The archive in memory has lost values of " + path + ".");
    for_each_value(box, [&](std::size_t local, std::size_t global) { values[local] = all[global]; });
  }

  const MemoryArchive& archive_;
};

// Gives a state the archive by its load(ArchiveReader&, how ...), and returns what that returns. Collective.
template <typename State, typename... How>
auto load(State& state, const MemoryArchive& archive, const How&... how) {
  MemoryReader reader(archive);
  return state.load(reader, how...);
}

}  // namespace thalweg::test
