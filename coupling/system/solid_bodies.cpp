#include "coupling/system/solid_bodies.hpp"

#include "core/base/check.hpp"
#include "core/base/error.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <span>
#include <type_traits>

namespace thalweg::coupling {

namespace {

// The 64-bit sums that structs consist of.
template <typename Sums>
std::span<std::int64_t> words_of(std::vector<Sums>& sums) {
  static_assert(std::is_standard_layout_v<Sums> && sizeof(Sums) % sizeof(std::int64_t) == 0);
  return {reinterpret_cast<std::int64_t*>(sums.data()), sums.size() * sizeof(Sums) / sizeof(std::int64_t)};
}

template <typename Sums>
std::vector<Sums> over_ranks(MPI_Comm communicator, std::vector<Sums> sums) {
  const std::span<std::int64_t> words = words_of(sums);
  const std::vector<WideSum> totals = wide_sums_over_ranks(communicator, words);
  std::transform(totals.begin(), totals.end(), words.begin(), [](const WideSum& total) { return total.narrowed(); });
  return sums;
}

// Sums over the links of a moving solid from which its debt of mass follows.
struct MassSums {
  std::int64_t mass;  // LatticeFixed
  bodies::LinkSums links;
};

}  // namespace

template <typename Real>
SolidBodies<Real>::SolidBodies(MPI_Comm communicator, bodies::Bodies<Real>& bodies, const Units& units,
                               const std::vector<dem::PrescribedMotion>& motions)
    : communicator_(communicator), bodies_(bodies), units_(units) {
  CHECK(motions.size() <= static_cast<std::size_t>(bodies.solids()));
  for (std::size_t s = 0; s < motions.size(); ++s) {
    const dem::PrescribedMotion& motion = motions[s];
    if (!motion.moves()) continue;
    const int solid = static_cast<int>(s);
    const bodies::Solids& shapes = bodies.solid_shapes();
    const Vec3 point = motion.turns() ? Vec3(motion.centre / units.spacing) : shapes.middle(solid);
    const Vec3 pivot = motion.turns() ? shapes.reference_on_axis(solid, point, motion.axis) : point;
    moving_.push_back({solid, motion, pivot, pivot - point, {}, {}});
  }
}

template <typename Real>
void SolidBodies<Real>::move(double time) {
  for (const Moving& m : moving_) {
    bodies::SolidMotion motion;
    motion.transform = {m.pivot, m.pivot + m.motion.displacement(time) / units_.spacing, m.motion.turn(time)};
    motion.velocity = m.motion.velocity_of(m.motion.centre, time) / units_.velocity();
    motion.angular_velocity = m.motion.spin() * units_.time_step;
    motion.returned = m.returned;
    bodies_.move_solid(m.solid, motion);
  }
}

template <typename Real>
void SolidBodies<Real>::settle_masses() {
  if (!any_moves()) return;
  std::vector<MassSums> sums;
  for (const Moving& m : moving_) {
    const bodies::BodySlot slot = bodies::slot_of_solid(m.solid);
    sums.push_back({bodies_.body(slot).mass, bodies_.link_sums(slot)});
  }
  sums = over_ranks(communicator_, std::move(sums));
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    Moving& m = moving_[k];
    m.returned = m.debt.settle(LatticeFixed::to_double(sums[k].mass), m.returned.mass(sums[k].links), sums[k].links);
  }
}

template <typename Real>
double SolidBodies<Real>::mass_owed() const {
  double owed = 0.0;
  for (const Moving& m : moving_) owed += m.debt.owed;
  return owed;
}

template <typename Real>
typename SolidBodies<Real>::LoadSums SolidBodies<Real>::sums() const {
  if (!loaded_.forces.empty()) return loaded_;
  LoadSums sums;
  for (int s = 0; s < bodies_.solids(); ++s) {
    sums.forces.push_back(bodies_.body(bodies::slot_of_solid(s)).force);
    sums.torques.push_back(bodies_.body(bodies::slot_of_solid(s)).torque);
  }
  return {over_ranks(communicator_, std::move(sums.forces)), over_ranks(communicator_, std::move(sums.torques))};
}

template <typename Real>
typename SolidBodies<Real>::Loads SolidBodies<Real>::loads() const {
  const LoadSums all = sums();
  Loads loads;
  for (const FixedVec3& force : all.forces) loads.forces.push_back(force.to_vec3());
  for (const FixedVec3& torque : all.torques) loads.torques.push_back(torque.to_vec3());
  for (const Moving& m : moving_) {
    const auto s = static_cast<std::size_t>(m.solid);
    if (!m.from_point.isZero(0.0)) loads.torques[s] += m.from_point.cross(loads.forces[s]);
  }
  return loads;
}

template <typename Real>
std::vector<Diagnostic> SolidBodies<Real>::diagnostics() const {
  const Loads all = loads();
  std::vector<Diagnostic> diagnostics;
  for (int s = 0; s < bodies_.solids(); ++s)
    add_vector(fmt::format("solid_{}_force", s), "N", all.forces[static_cast<std::size_t>(s)] * units_.force(),
               diagnostics);
  for (const Moving& m : moving_)
    if (m.motion.turns())
      add_vector(fmt::format("solid_{}_torque", m.solid), "N m",
                 all.torques[static_cast<std::size_t>(m.solid)] * units_.torque(), diagnostics);
  return diagnostics;
}

template <typename Real>
void SolidBodies<Real>::save(ArchiveWriter& archive) const {
  LoadSums all = sums();
  const std::vector<std::uint64_t> shape{all.forces.size(), 3};
  write_whole<std::int64_t>(archive, communicator_, "solids/force", words_of(all.forces), shape);
  if (!any_moves()) return;
  write_whole<std::int64_t>(archive, communicator_, "solids/torque", words_of(all.torques), shape);
  save_debts(archive);
}

template <typename Real>
void SolidBodies<Real>::load(ArchiveReader& archive) {
  const std::uint64_t solids = static_cast<std::uint64_t>(bodies_.solids());
  const std::vector<std::uint64_t> shape{solids, 3};
  const auto has = [&](const char* path, const std::vector<std::uint64_t>& wanted) {
    return archive.has(path) && archive.shape(path) == wanted;
  };
  if (!has("solids/force", shape))
    throw InputError(fmt::format("The checkpoint does not hold {} solids as this case does; keep the list solids.",
                                 bodies_.solids()));
  if (any_moves() ? !has("solids/debt", {moving_.size(), debt_width}) : archive.has("solids/debt")) {
    const std::vector<std::uint64_t> there =
        archive.has("solids/debt") ? archive.shape("solids/debt") : std::vector<std::uint64_t>();
    throw InputError(fmt::format("{} solids move in the checkpoint and {} in this case; keep their motions.",
                                 there.empty() ? 0 : there.front(), moving_.size()));
  }
  loaded_.forces.resize(solids);
  loaded_.torques.resize(solids);
  archive.read("solids/force", words_of(loaded_.forces), {shape, {0, 0}, shape});
  if (!any_moves()) return;
  archive.read("solids/torque", words_of(loaded_.torques), {shape, {0, 0}, shape});
  load_debts(archive);
}

template <typename Real>
void SolidBodies<Real>::save_debts(ArchiveWriter& archive) const {
  std::vector<double> values;
  for (const Moving& m : moving_)
    values.insert(values.end(), {m.debt.owed, m.debt.mean_loss, m.debt.wanted, m.returned.density, m.returned.slope[0],
                                 m.returned.slope[1], m.returned.slope[2]});
  write_whole<double>(archive, communicator_, "solids/debt", values, {moving_.size(), debt_width});
}

template <typename Real>
void SolidBodies<Real>::load_debts(ArchiveReader& archive) {
  const std::vector<std::uint64_t> shape{moving_.size(), debt_width};
  std::vector<double> values(moving_.size() * debt_width);
  archive.read("solids/debt", std::span<double>(values), {shape, {0, 0}, shape});
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const double* v = &values[debt_width * k];
    moving_[k].debt = {v[0], v[1], v[2]};
    moving_[k].returned = {v[3], {v[4], v[5], v[6]}};
  }
}

template class SolidBodies<float>;
template class SolidBodies<double>;

}  // namespace thalweg::coupling
