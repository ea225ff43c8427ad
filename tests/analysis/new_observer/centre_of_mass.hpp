// An observer added by a contributor, as CONTRIBUTING.md describes: height of the centre of mass of all grains,
//
//   z_c = sum of m z / sum of m,
//
// in every row of the series, and its mean over time in the summary. extend.py puts it where it belongs.
#pragma once

#include "analysis/observer/mean_observer.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/reproducible_sum.hpp"

namespace thalweg::analysis {

struct CentreOfMassKeys {
  static constexpr const char* section = "centre_of_mass";
  static constexpr const char* meaning = "height of the centre of mass of the grains, and its mean";
  static constexpr Needs needs = Needs::grains;
  double from = 0.0;    // s: the mean begins here
  double every = 0.01;  // s: between measurements
  bool operator==(const CentreOfMassKeys&) const = default;
};

class CentreOfMass : public MeanObserver {
public:
  CentreOfMass(MPI_Comm communicator, const CentreOfMassKeys& keys)
      : MeanObserver(communicator, CentreOfMassKeys::section, keys.from, keys.every) {}

  std::vector<Diagnostic> diagnostics() const override { return {{"centre_of_mass", "m", height_}}; }

  std::vector<Diagnostic> results() const override {
    std::vector<Diagnostic> results{{"centre_of_mass_mean", "m", sum_ / static_cast<double>(measurements())}};
    add_count(results);
    return results;
  }

private:
  bool measure(const Snapshot& snapshot, bool /*counts*/) override {
    const GrainView& grains = snapshot.grains;
    std::vector<double> terms;
    for (std::size_t n = 0; n < grains.id.size(); ++n)
      terms.insert(terms.end(), {grains.mass[n], grains.mass[n] * grains.position[n].z()});
    const std::vector<double> sums = reproducible_sums(communicator(), terms, 2);
    height_ = sums[1] / sums[0];
    return true;
  }
  void add(const Snapshot& /*snapshot*/) override { sum_ += height_; }

  void save_sums(ArchiveWriter& archive, const std::string& group) const override {
    save_count(archive, group);
    write_whole(archive, communicator(), group + "/sums", std::vector{height_, sum_});
  }
  bool load_sums(ArchiveReader& archive, const std::string& group) override {
    load_count(archive, group);
    const auto sums = read_whole<double>(archive, group + "/sums", {2});
    height_ = sums[0];
    sum_ = sums[1];
    return true;
  }

  double height_ = 0.0, sum_ = 0.0;  // m: latest, and of the measurements that count
};

inline void describe(SectionVisitor& visit, CentreOfMassKeys& keys) {
  describe_from(visit, keys.from);
  describe_every(visit, keys.every);
}

inline std::unique_ptr<Observer> make_observer(const CentreOfMassKeys& keys, const RunContext& /*run*/,
                                               const RunningSystem& system) {
  return std::make_unique<CentreOfMass>(system.communicator, keys);
}

inline ObserverMemory memory_of(const CentreOfMassKeys&, const RunContext&, const RunSize&) {
  return {};  // it keeps nothing of a grain
}

}  // namespace thalweg::analysis
