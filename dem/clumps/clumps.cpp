#include "dem/clumps/clumps.hpp"

#include "core/parallel/mpi_session.hpp"
#include "dem/motion/grain_volume.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace thalweg::dem {

namespace {

void copy(const Vec3& from, double (&to)[3]) { std::copy(from.data(), from.data() + 3, to); }

// C^-1 v of a symmetric matrix without negative eigenvalues, where some may be zero: in the space of the others.
Vec3 solution_of(const Mat3& matrix, const Vec3& v) {
  constexpr double rounding = 1e-12;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(matrix);
  Vec3 solution = Vec3::Zero();
  for (int n = 0; n < 3; ++n)
    if (axes.eigenvalues()[n] > rounding * axes.eigenvalues()[2])
      solution += axes.eigenvectors().col(n).dot(v) / axes.eigenvalues()[n] * axes.eigenvectors().col(n);
  return solution;
}

}  // namespace

ClumpRow row_of(const Clump& clump) {
  const Quaternion& q = clump.orientation;
  ClumpRow row{clump.id,
               clump.members,
               static_cast<std::int64_t>(clump.motion),
               clump.mass,
               clump.volume,
               {},
               {q.w, q.x, q.y, q.z},
               {},
               {},
               {},
               {}};
  copy(clump.moments, row.moments);
  copy(clump.centre, row.centre);
  copy(clump.velocity, row.velocity);
  copy(clump.angular_momentum, row.angular_momentum);
  copy(clump.angular_velocity, row.angular_velocity);
  return row;
}

Clump clump_of(const ClumpRow& row) {
  return {row.id,
          row.members,
          static_cast<Motion>(row.motion),
          row.mass,
          row.volume,
          Vec3(row.moments),
          {row.orientation[0], row.orientation[1], row.orientation[2], row.orientation[3]},
          Vec3(row.centre),
          Vec3(row.velocity),
          Vec3(row.angular_momentum),
          Vec3(row.angular_velocity)};
}

Clump clump_of(const ClumpSeed& seed, const PeriodicBox& box) {
  const Vec3 moments = seed.density * seed.shape->moments;
  const Quaternion orientation = seed.principal_orientation();
  return {seed.id,
          static_cast<std::int64_t>(seed.shape->members.size()),
          seed.motion,
          seed.mass(),
          seed.shape->volume,
          moments,
          orientation,
          box.wrapped(seed.position),
          seed.velocity,
          angular_momentum_of(orientation, seed.angular_velocity, moments),
          seed.angular_velocity};
}

void Clumps::find_members(const GrainStore& store) {
  first_slot_.clear();
  first_arm_.clear();
  offsets_.clear();
  const auto end = store.id.begin() + static_cast<std::ptrdiff_t>(store.owned);
  for (const Clump& clump : clumps_) {
    const auto found = std::lower_bound(store.id.begin(), end, clump.id);
    first_slot_.push_back(static_cast<std::size_t>(found - store.id.begin()));
    first_arm_.push_back(offsets_.size());
    for (std::int64_t m = 0; m < clump.members; ++m)
      offsets_.push_back(store.offset[first_slot_.back() + static_cast<std::size_t>(m)]);
  }
  arms_.resize(offsets_.size());
  loads_.resize(clumps_.size());
  for (std::size_t n = 0; n < clumps_.size(); ++n) turn_arms(n);
}

void Clumps::compute_body_forces(const std::function<Vec3(double, double)>& body_force) {
  body_force_.clear();
  for (const Clump& clump : clumps_) body_force_.push_back(body_force(clump.mass, radius_of(clump)));
}

double Clumps::radius_of(const Clump& clump) const { return radius_of_volume(clump.volume, disk_thickness_); }

void Clumps::turn_arms(std::size_t n) {
  const Eigen::Matrix3d turn = rotation_matrix(clumps_[n].orientation);
  const std::size_t first = first_arm_[n];
  for (std::size_t m = first; m < first + member_count(n); ++m) arms_[m] = turn * offsets_[m];
}

// Of all shares with the sum 1 and without a moment, sum w_m r_m = 0, those nearest to equal ones:
// w_m = 1/N - (r_m - r) . C^-1 r, r the mean of r_m, C the sum of (r_m - r)(r_m - r)^T.
void Clumps::share_body_force(std::vector<Vec3>& of_slot) const {
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    const std::span<const Vec3> offsets(&offsets_[first_arm_[n]], member_count(n));
    Vec3 mean = Vec3::Zero();
    for (const Vec3& offset : offsets) mean += offset / static_cast<double>(offsets.size());
    Mat3 spread = Mat3::Zero();
    for (const Vec3& offset : offsets) spread += (offset - mean) * (offset - mean).transpose();
    const Vec3 tilt = solution_of(spread, mean);
    for (std::size_t m = 0; m < offsets.size(); ++m)
      of_slot[first_slot_[n] + m] =
          (1.0 / static_cast<double>(offsets.size()) - (offsets[m] - mean).dot(tilt)) * body_force_[n];
  }
}

const Clump& Clumps::with_id(GlobalId id) const {
  return *std::lower_bound(clumps_.begin(), clumps_.end(), id,
                           [](const Clump& c, GlobalId wanted) { return c.id < wanted; });
}

double Clumps::volume_radius(GlobalId id) const { return radius_of(with_id(id)); }

double Clumps::width(GlobalId id) const {
  constexpr double least = 0.2;
  const Clump& clump = with_id(id);
  const double square = 10.0 * (clump.moments.sum() - 2.0 * clump.moments.maxCoeff()) / clump.mass;
  return std::max(std::sqrt(std::max(0.0, square)), least * 2.0 * radius_of(clump));
}

void Clumps::wrap(const PeriodicBox& box) {
  for (Clump& clump : clumps_) clump.centre = box.wrapped(clump.centre);
}

void Clumps::assign_owners(const Decomposition& decomposition, std::vector<int>& owner_of_slot) const {
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    std::fill_n(owner_of_slot.begin() + static_cast<std::ptrdiff_t>(first_slot_[n]), member_count(n),
                decomposition.owner_of(clumps_[n].centre));
}

void Clumps::migrate(const Decomposition& decomposition, MPI_Comm communicator) {
  std::vector<ClumpRow> rows;
  std::vector<int> owner;
  for (const Clump& clump : clumps_) {
    rows.push_back(row_of(clump));
    owner.push_back(decomposition.owner_of(clump.centre));
  }
  rows = exchange_rows(communicator, rows, owner);
  std::sort(rows.begin(), rows.end(), [](const ClumpRow& a, const ClumpRow& b) { return a.id < b.id; });
  clumps_.clear();
  for (const ClumpRow& row : rows) clumps_.push_back(clump_of(row));
}

void Clumps::add_loads(std::size_t n, const GrainStore& store, Vec3& force, Vec3& torque) const {
  for (std::size_t m = 0; m < member_count(n); ++m) {
    const std::size_t slot = first_slot_[n] + m;
    force += store.load_force[slot];
    torque += store.load_torque[slot] + arm(n, m).cross(store.load_force[slot]);
  }
  force += body_force_[n];
}

void Clumps::gather_loads(const GrainStore& store) {
  for (std::size_t n = 0; n < clumps_.size(); ++n) gather_load(n, store);
}

void Clumps::gather_load(std::size_t n, const GrainStore& store) {
  loads_[n] = {Vec3::Zero(), Vec3::Zero()};
  add_loads(n, store, loads_[n].force, loads_[n].torque);
}

void Clumps::set_central_force(std::size_t n, const Vec3& force, GrainStore& store) {
  const Vec3 share = force / static_cast<double>(member_count(n));
  for (std::size_t m = 0; m < member_count(n); ++m) {
    const std::size_t slot = first_slot_[n] + m;
    store.load_force[slot] = share;
    store.load_torque[slot] = -arm(n, m).cross(share);
  }
  gather_load(n, store);
}

void Clumps::stop_along_floor(std::size_t n, PackedGrainState& grains) {
  Clump& clump = clumps_[n];
  clump.velocity[0] = clump.velocity[1] = 0.0;
  Vec3 pull = loads_[n].force;
  for (std::size_t m = 0; m < member_count(n); ++m) pull += vector_of(grains[first_slot_[n] + m].force);
  const auto members = static_cast<double>(member_count(n));
  const Vec3 share(-pull[0] / members, -pull[1] / members, 0.0);
  for (std::size_t m = 0; m < member_count(n); ++m) {
    PackedGrain& member = grains[first_slot_[n] + m];
    member.force += double4(share);
    member.torque -= double4(arm(n, m).cross(share));
  }
}

void Clumps::half_kicks(const PackedGrainState& grains, double time_step, int kicks) {
  const double half = 0.5 * time_step;
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    Clump& clump = clumps_[n];
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (std::size_t m = 0; m < member_count(n); ++m) {
      const PackedGrain& member = grains[first_slot_[n] + m];
      const Vec3 pull = vector_of(member.force);
      force += pull;
      torque += vector_of(member.torque) + arm(n, m).cross(pull);
    }
    force += loads_[n].force;
    torque += loads_[n].torque;
    for (int k = 0; k < kicks; ++k) {
      if (!holds_translation(clump.motion)) clump.velocity += half / clump.mass * force;
      if (!holds_rotation(clump.motion)) clump.angular_momentum += half * torque;
    }
    if (!holds_rotation(clump.motion))
      clump.angular_velocity = angular_velocity_of(clump.orientation, clump.angular_momentum, clump.moments);
  }
}

void Clumps::drift(double time_step) {
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    Clump& clump = clumps_[n];
    clump.centre += time_step * clump.velocity;
    if (holds_rotation(clump.motion)) {
      clump.orientation = turned(clump.orientation, clump.angular_velocity, time_step);
      clump.angular_momentum = angular_momentum_of(clump.orientation, clump.angular_velocity, clump.moments);
    } else {
      clump.orientation = freely_turned(clump.orientation, clump.angular_momentum, clump.moments, time_step);
      clump.angular_velocity = angular_velocity_of(clump.orientation, clump.angular_momentum, clump.moments);
    }
    turn_arms(n);
  }
}

void Clumps::place(PackedGrainState& grains, const PeriodicBox& box) const {
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    const Clump& clump = clumps_[n];
    for (std::size_t m = 0; m < member_count(n); ++m) {
      PackedGrain& member = grains[first_slot_[n] + m];
      const Vec3 r = arm(n, m);
      // The centre may be just outside the box, and no member is further than half the box from it.
      member.position = dem::double4(box.wrapped(box.wrapped(clump.centre) + r), member.position[3]);
      member.velocity = dem::double4(clump.velocity + clump.angular_velocity.cross(r));
      member.spin = dem::double4(clump.angular_velocity);
    }
  }
}

Vec3 Clumps::force(std::size_t n, const GrainStore& store) const {
  Vec3 force = Vec3::Zero(), unused = Vec3::Zero();
  for (std::size_t m = 0; m < member_count(n); ++m) force += store.contact_force[first_slot_[n] + m];
  add_loads(n, store, force, unused);
  return force;
}

Vec3 Clumps::torque(std::size_t n, const GrainStore& store) const {
  Vec3 unused = Vec3::Zero(), torque = Vec3::Zero();
  for (std::size_t m = 0; m < member_count(n); ++m) {
    const std::size_t slot = first_slot_[n] + m;
    torque += store.contact_torque[slot] + arm(n, m).cross(store.contact_force[slot]);
  }
  add_loads(n, store, unused, torque);
  return torque;
}

double Clumps::largest_pull(const GrainStore& store) const {
  double largest = 0.0;
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    const Clump& clump = clumps_[n];
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    add_loads(n, store, force, torque);
    double reach = 0.0;
    for (std::size_t m = 0; m < member_count(n); ++m) reach = std::max(reach, arm(n, m).norm());
    if (!holds_translation(clump.motion)) largest = std::max(largest, force.norm() / clump.mass);
    if (!holds_rotation(clump.motion))
      largest = std::max(largest, force.norm() / clump.mass + torque.norm() / clump.moments.minCoeff() * reach);
  }
  return largest;
}

}  // namespace thalweg::dem
