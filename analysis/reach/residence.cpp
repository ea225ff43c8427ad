#include "analysis/reach/residence.hpp"

#include "core/parallel/mpi_count.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

constexpr double shortest_stay = 1e-3, longest_stay = 1e3;  // in units of time
constexpr int bins_of_stays = 120;                          // 20 a decade

}  // namespace

Residence::Residence(MPI_Comm communicator, double time)
    : communicator_(communicator),
      stays_(Histogram::geometric(shortest_stay * time, longest_stay * time, bins_of_stays)) {}

void Residence::take(double time, std::int64_t arrived, const std::vector<double>& stays) {
  last_time_ = time;
  newcomers_ += arrived;
  sum_of_arrivals_ += static_cast<double>(arrived) * time;
  std::vector<std::int64_t> counts(stays_.counts().size(), 0);
  for (const double stay : stays) ++counts[stays_.bin_of(stay)];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), mpi_count(counts.size()), MPI_INT64_T, MPI_SUM, communicator_);
  std::int64_t ended = 0;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    stays_.counts()[b] += counts[b];
    ended += counts[b];
  }
  if (ended == 0) return;
  const double sum = reproducible_sums(communicator_, stays, 1)[0];
  sum_of_stays_ += sum;
  newcomers_ -= ended;
  sum_of_arrivals_ = newcomers_ == 0 ? 0.0 : sum_of_arrivals_ - (static_cast<double>(ended) * time - sum);
}

std::vector<Diagnostic> Residence::results() const {
  const auto count = static_cast<double>(stays_.total());
  const auto of_stays = [count](double value) { return count > 0.0 ? value : std::nan(""); };
  return {{"residence_times", "1", count},
          {"residence_time_mean", "s", of_stays(sum_of_stays_ / count)},
          {"residence_time_10", "s", of_stays(stays_.quantile(0.1))},
          {"residence_time_50", "s", of_stays(stays_.quantile(0.5))},
          {"residence_time_90", "s", of_stays(stays_.quantile(0.9))},
          {"newcomers", "1", static_cast<double>(newcomers_)},
          {"newcomer_age_mean", "s",
           newcomers_ > 0 ? last_time_ - sum_of_arrivals_ / static_cast<double>(newcomers_) : std::nan("")}};
}

std::vector<Profile> Residence::profiles() const {
  const std::uint64_t edges = stays_.edges().size(), cells = stays_.counts().size();
  return {{"residence_time_edges",
           "s",
           {"residence_time_edges"},
           {},
           {edges},
           {stays_.edges().begin(), stays_.edges().end()}},
          {"residence_time_count",
           "1",
           {"residence_time_bin"},
           {},
           {cells},
           {stays_.counts().begin(), stays_.counts().end()}}};
}

void Residence::save(ArchiveWriter& archive, const std::string& group) const {
  archive.attribute(group + "/sum_of_stays", sum_of_stays_);
  archive.attribute(group + "/newcomers", newcomers_);
  archive.attribute(group + "/sum_of_arrivals", sum_of_arrivals_);
  archive.attribute(group + "/last_time", last_time_);
  write_whole(archive, communicator_, group + "/stays",
              std::vector<std::int64_t>(stays_.counts().begin(), stays_.counts().end()));
}

void Residence::load(ArchiveReader& archive, const std::string& group) {
  const auto counts = read_whole<std::int64_t>(archive, group + "/stays", {stays_.counts().size()});
  std::copy(counts.begin(), counts.end(), stays_.counts().begin());
  sum_of_stays_ = archive.real_attribute(group + "/sum_of_stays");
  newcomers_ = archive.integer_attribute(group + "/newcomers");
  sum_of_arrivals_ = archive.real_attribute(group + "/sum_of_arrivals");
  last_time_ = archive.real_attribute(group + "/last_time");
}

}  // namespace thalweg::analysis
