#include "coupling/loads/mass_budget.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::coupling {

namespace {

constexpr int fraction_bits = 44;  // of LatticeFixed

constexpr const char* names[MassBudget::terms] = {"links", "covered_cells", "uncovered_cells", "corrections"};

}  // namespace

// Links took the owed mass before.
void MassBudget::open(double excess, double owed) {
  sums_ = {};
  kept_ = excess + owed;
  if (rank_of(communicator_) == 0) record(links, -owed);
}

std::array<WideSum, MassBudget::terms> MassBudget::totals_exact() const {
  std::array<WideSum, terms> totals = sums_;
  sum_over_ranks(communicator_, totals);
  return totals;
}

std::array<double, MassBudget::terms> MassBudget::totals() const {
  std::array<double, terms> totals{};
  const std::array<WideSum, terms> exact = totals_exact();
  for (std::size_t k = 0; k < terms; ++k) totals[k] = exact[k].to_double(fraction_bits);
  return totals;
}

std::vector<Diagnostic> MassBudget::diagnostics(double excess, double owed, const Units& units) const {
  const double cell = units.density * std::pow(units.spacing, 3);
  const std::array<double, terms> t = totals();
  const double by_walls = excess - kept_ - t[links] - t[covered] - t[uncovered] - t[corrections];
  return {{"excess_mass", "kg", cell * excess},
          {"mass_by_links", "kg", cell * t[links]},
          {"mass_by_covered_cells", "kg", cell * t[covered]},
          {"mass_by_uncovered_cells", "kg", cell * t[uncovered]},
          {"mass_by_corrections", "kg", cell * t[corrections]},
          {"mass_by_walls", "kg", cell * by_walls},
          {"mass_owed", "kg", cell * owed}};
}

void MassBudget::save(ArchiveWriter& archive) const {
  archive.attribute("mass/start", kept_);
  const std::array<WideSum, terms> totals = totals_exact();
  for (std::size_t k = 0; k < terms; ++k) {
    archive.attribute(fmt::format("mass/{}_high", names[k]), totals[k].high);
    archive.attribute(fmt::format("mass/{}_low", names[k]), totals[k].low);
  }
}

// The whole sum is the first rank's from here on.
void MassBudget::load(ArchiveReader& archive) {
  kept_ = archive.real_attribute("mass/start");
  for (std::size_t k = 0; k < terms; ++k) {
    const WideSum total{archive.integer_attribute(fmt::format("mass/{}_high", names[k])),
                        archive.integer_attribute(fmt::format("mass/{}_low", names[k]))};
    sums_[k] = rank_of(communicator_) == 0 ? total : WideSum{};
  }
}

}  // namespace thalweg::coupling
