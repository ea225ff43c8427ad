#include "benchmarks/validation/turbulent_channel/plane_statistics.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/sums/fixed_point.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace thalweg::benchmark {

namespace {

using CellSum = FixedPoint<36>;

}  // namespace

template <typename Real>
PlaneSums plane_sums(const lbm::Fluid<Real>& fluid, MPI_Comm communicator, const Decomposition& decomposition) {
  const int planes = decomposition.cells()[2];
  std::vector<std::int64_t> sums(7 * static_cast<std::size_t>(planes), 0);
  const Block& block = fluid.block();
  const Index3 n = block.size();
  for (int z = 0; z < n[2]; ++z) {
    std::int64_t* s = sums.data() + 7 * static_cast<std::size_t>(block.lower[2] + z);
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const Vec3 u = fluid.state_at(fluid.indexing().index(x, y, z)).velocity;
        const double terms[7] = {u.x(), u.y(), u.z(), u.x() * u.x(), u.y() * u.y(), u.z() * u.z(), u.x() * u.z()};
        for (int k = 0; k < 7; ++k) s[k] += CellSum::from(terms[k]);
      }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_INT64_T, MPI_SUM, communicator);
  const double area = static_cast<double>(decomposition.cells()[0]) * decomposition.cells()[1];
  PlaneSums result(planes);
  for (int z = 0; z < planes; ++z)
    for (int k = 0; k < 7; ++k) result[z][k] = CellSum::to_double(sums[7 * z + k]) / area;
  return result;
}

template PlaneSums plane_sums(const lbm::Fluid<float>&, MPI_Comm, const Decomposition&);
template PlaneSums plane_sums(const lbm::Fluid<double>&, MPI_Comm, const Decomposition&);

void PlaneStatistics::add(const PlaneSums& sums) {
  for (std::size_t z = 0; z < sums.size(); ++z)
    for (int k = 0; k < 7; ++k) sums_[z][k] += sums[z][k];
  ++samples_;
}

void PlaneStatistics::clear() {
  for (auto& plane : sums_) plane.fill(0.0);
  samples_ = 0;
}

PlaneMeans PlaneStatistics::means() const {
  PlaneMeans m;
  for (const auto& sum : sums_) {
    std::array<double, 7> s = sum;
    for (double& value : s) value /= static_cast<double>(samples_);
    m.velocity.push_back(s[0]);
    m.uu.push_back(s[3] - s[0] * s[0]);
    m.vv.push_back(s[4] - s[1] * s[1]);
    m.ww.push_back(s[5] - s[2] * s[2]);
    m.uw.push_back(s[6] - s[0] * s[2]);
  }
  return m;
}

void PlaneStatistics::save(ArchiveWriter& archive, MPI_Comm communicator) const {
  const std::uint64_t planes = rank_of(communicator) == 0 ? sums_.size() : 0;
  const ArrayBox box{{sums_.size(), 7}, {0, 0}, {planes, 7}};
  archive.write("statistics/sums", std::span<const double>(sums_.data()->data(), 7 * planes), box);
  archive.attribute("statistics/samples", samples_);
}

void PlaneStatistics::load(ArchiveReader& archive) {
  const ArrayBox box{{sums_.size(), 7}, {0, 0}, {sums_.size(), 7}};
  archive.read("statistics/sums", std::span<double>(sums_.data()->data(), 7 * sums_.size()), box);
  samples_ = archive.integer_attribute("statistics/samples");
}

void write_profile(const std::string& file, const PlaneMeans& means, double viscosity, double friction_velocity) {
  std::ofstream out(file);
  const double u = friction_velocity;
  const std::size_t n = means.velocity.size();
  out << "y_plus,U_plus,u_rms_plus,v_rms_plus,w_rms_plus,minus_uw_plus,difference_of_halves_plus\n";
  for (std::size_t low = 0; low < n / 2 + n % 2; ++low) {
    const std::size_t high = n - 1 - low;
    const auto mean = [&](const std::vector<double>& v) { return 0.5 * (v[low] + v[high]); };
    const auto rms = [&](const std::vector<double>& v) { return std::sqrt(std::max(0.0, mean(v))) / u; };
    out << fmt::format("{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n",
                       (static_cast<double>(low) + 0.5) * u / viscosity, mean(means.velocity) / u, rms(means.uu),
                       rms(means.vv), rms(means.ww), -0.5 * (means.uw[low] - means.uw[high]) / (u * u),
                       (means.velocity[low] - means.velocity[high]) / u);
  }
  if (!out) throw RunError(fmt::format("Cannot write the file '{}'.", file));
}

}  // namespace thalweg::benchmark
