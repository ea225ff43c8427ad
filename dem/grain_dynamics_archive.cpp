// Saving and loading of GrainDynamics. Datasets, one row a grain in order of id: radius, mass, motion, material,
// position, velocity, angular_velocity, contact_force, contact_torque, load_force, load_torque, attached. One row a
// contact, sorted by ids: contact_ids (lower id; higher id, or what solid_key() says of walls and solids), and what its
// law keeps, by the names that the law gives to the parts: contact_spring or contact_mindlin_spring; with rolling
// friction contact_rolling or contact_mindlin_rolling; and so on. Where there are clumps also, of each grain, clump
// (its clump's id, or -1) and offset, and one row a clump, sorted by id: clump_id, clump_members, clump_motion,
// clump_mass and so on with the names of struct ClumpRow. Where ids have gaps, because grains have left or come in,
// also the column id; and what supplies and sinks have brought and taken, in attributes, and the bodies that return, as
// such rows below "returning".
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/row_range.hpp"
#include "core/state/whole_dataset.hpp"
#include "dem/contact/contact_archive.hpp"
#include "dem/grain_dynamics.hpp"
#include "dem/grain_space.hpp"
#include "dem/ranks/grain_archive.hpp"
#include "dem/ranks/grain_batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace thalweg::dem {

namespace {

// Attached columns of a saved grain.
int saved_width(const ArchiveReader& archive, const std::string& group) {
  const std::string name = group + "/attached";
  if (!archive.has(name)) return 0;
  const std::vector<std::uint64_t> shape = archive.shape(name);
  return shape.size() < 2 ? 1 : static_cast<int>(shape[1]);
}

// True if the saved columns fit this run. (States saved before the system's columns were counted have only the total.)
bool has_columns(const ArchiveReader& archive, const std::string& group, int width) {
  const std::string name = group + "/system_columns";
  return saved_width(archive, group) == width && (!archive.has(name) || archive.integer_attribute(name) == width);
}

// Throws on every rank, naming the same grain, the one with the lowest id.
void check_loaded(const GrainBatch& batch, const GrainSpace& space, MPI_Comm communicator) {
  struct Outlier {
    std::int64_t id = std::numeric_limits<std::int64_t>::max(), axis = 0;
    double x = 0.0;
  } outlier;
  for (const GrainRow& row : batch.rows)
    for (int axis = 0; axis < 3; ++axis) {
      const double x = row.value[GrainRow::position][axis];
      const bool inside = x >= space.lower()[axis] - row.radius && x <= space.upper()[axis] + row.radius;
      if (!inside && row.id < outlier.id) outlier = {row.id, axis, x};
    }
  std::int64_t lowest = 0;
  MPI_Allreduce(&outlier.id, &lowest, 1, MPI_INT64_T, MPI_MIN, communicator);
  if (lowest == std::numeric_limits<std::int64_t>::max()) return;
  int sender = outlier.id == lowest ? rank_of(communicator) : 0, root = 0;
  MPI_Allreduce(&sender, &root, 1, MPI_INT, MPI_MAX, communicator);
  MPI_Bcast(&outlier, sizeof(Outlier), MPI_BYTE, root, communicator);
  throw InputError(fmt::format("Grain {} of the saved state has {} = {:g} m, outside the box of {:g} to {:g} m.",
                               outlier.id, "xyz"[outlier.axis], outlier.x,
                               space.lower()[static_cast<int>(outlier.axis)],
                               space.upper()[static_cast<int>(outlier.axis)]));
}

// Lightest grain of each material over all ranks: grains, and clumps with the mass that their contacts feel.
std::vector<LightestGrain> lightest_of(const GrainStore& store, const std::vector<Clump>& clumps, int materials,
                                       MPI_Comm communicator) {
  std::vector<LightestGrain> lightest(static_cast<std::size_t>(materials));
  for (std::size_t s = 0; s < store.owned; ++s)
    if (store.motion[s] == Motion::free || store.motion[s] == Motion::held_rotation)
      lightest[store.material[s]].include(store.mass[s], store.radius[s]);
  for (const Clump& clump : clumps) {
    if (holds_translation(clump.motion)) continue;
    const auto first = static_cast<std::size_t>(
        std::lower_bound(store.id.begin(), store.id.begin() + static_cast<std::ptrdiff_t>(store.owned), clump.id) -
        store.id.begin());
    const std::span<const Vec3> offsets(&store.offset[first], static_cast<std::size_t>(clump.members));
    const double mass = least_contact_mass(clump.mass, clump.moments, offsets);
    for (std::size_t m = first; m < first + offsets.size(); ++m)
      lightest[store.material[m]].include(mass, store.radius[m]);
  }
  share_over_ranks(communicator, lightest);
  return lightest;
}

// The ranks that have read the grains, by id.
class Readers {
public:
  // batch: the rows that this rank has read, in order of id. Collective.
  Readers(const GrainBatch& batch, MPI_Comm communicator) : first_(static_cast<std::size_t>(size_of(communicator))) {
    const GlobalId first = batch.rows.empty() ? std::numeric_limits<GlobalId>::max() : batch.rows.front().id;
    MPI_Allgather(&first, 1, MPI_INT64_T, first_.data(), 1, MPI_INT64_T, communicator);
    for (std::size_t rank = first_.size() - 1; rank > 0; --rank)
      first_[rank - 1] = std::min(first_[rank - 1], first_[rank]);
  }
  int rank_of(GlobalId id) const {
    return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), id) - first_.begin()) - 1;
  }

private:
  std::vector<GlobalId> first_;  // id of each rank, or of the next one that has read any
};

// Number of the row with an id; none: it is not in the batch, which is in order of id.
std::optional<std::size_t> row_of(const GrainBatch& batch, GlobalId id) {
  const auto found = std::lower_bound(batch.rows.begin(), batch.rows.end(), id,
                                      [](const GrainRow& row, GlobalId wanted) { return row.id < wanted; });
  if (found == batch.rows.end() || found->id != id) return std::nullopt;
  return static_cast<std::size_t>(found - batch.rows.begin());
}

}  // namespace

void GrainDynamics::save(ArchiveWriter& archive, const std::string& group) const {
  const int ranks = size_of(communicator_);
  archive.attribute(group + "/walls", static_cast<std::int64_t>(parameters_.walls.size()));
  if (!parameters_.solids.empty())
    archive.attribute(group + "/solids", static_cast<std::int64_t>(parameters_.solids.size()));
  archive.attribute(group + "/sub_steps", steps_done_);
  archive.attribute(group + "/time", time());
  archive.attribute(group + "/system_columns", static_cast<std::int64_t>(parameters_.attached_width));
  assemblies_.save(archive, group, communicator_);
  // Every rank writes the rows of an even share of the ids, which is one of the rows where no id is missing.
  std::vector<int> home;
  for (std::size_t s = 0; s < store_.owned; ++s) home.push_back(rank_of_row(store_.id[s], id_limit(), ranks));
  const GrainBatch batch = exchange_grains(communicator_, owned_grains(store_), home, store_.attached_width);
  const RowRange share = RowRange::of_rows(static_cast<std::int64_t>(batch.rows.size()), communicator_);
  write_grains(archive, group, batch, share, store_.attached_width, id_limit() != global_count_, clump_count_ > 0);
  save_turnover(archive, group);
  if (clump_count_ > 0) {
    std::vector<ClumpRow> clumps;
    home.clear();
    for (std::size_t n = 0; n < clumps_.size(); ++n) {
      clumps.push_back(row_of(clumps_[n]));
      home.push_back(rank_of_row(clumps.back().id, id_limit(), ranks));
    }
    clumps = exchange_rows(communicator_, clumps, home);
    const RowRange clump_share = RowRange::of_rows(static_cast<std::int64_t>(clumps.size()), communicator_);
    write_clumps(archive, group, std::move(clumps), clump_share);
  }

  // A pair known to two ranks is written by the owner of its lower id.
  const ContactHistories known = histories_of(list_, store_, planes_.size());
  ContactHistories mine(known.width());
  const auto owned_end = store_.id.begin() + static_cast<std::ptrdiff_t>(store_.owned);
  home.clear();
  for (std::size_t n = 0; n < known.size(); ++n) {
    const GlobalId first = known.key(n).first;
    if (!std::binary_search(store_.id.begin(), owned_end, first)) continue;
    mine.add(known.key(n), known.values(n));
    home.push_back(rank_of_row(first, id_limit(), ranks));
  }
  ContactHistories rows = mine.exchanged(communicator_, home);
  rows.sort();
  write_histories(archive, group, rows, history_parts_of(list_), communicator_);
}

void GrainDynamics::load(ArchiveReader& archive, const std::string& group) { restore(archive, group, Restored::whole); }

void GrainDynamics::take(ArchiveReader& archive, const std::string& group, bool with_columns) {
  const auto saved = static_cast<std::int64_t>(archive.shape(group + "/radius").at(0));
  if (global_count_ > 0 && saved != global_count_)
    throw InputError(fmt::format("There are {} grains, but this system has {}.", saved, global_count_));
  if (archive.has(group + "/id"))
    throw InputError(
        "Grains have entered or left the other run, so they are no longer those of this case; give the bed.h5 that it "
        "has written as placement.file of a population.");
  if (assemblies_.any())
    throw InputError("A case with rigid populations (motion) cannot take over grains; give their placements instead.");
  restore(archive, group, with_columns ? Restored::start : Restored::start_without_columns);
}

void GrainDynamics::restore(ArchiveReader& archive, const std::string& group, Restored what) {
  const bool as_start = what != Restored::whole;
  const int ranks = size_of(communicator_), me = rank_of(communicator_);
  const std::int64_t walls = archive.integer_attribute(group + "/walls");
  const std::int64_t solids = archive.has(group + "/solids") ? archive.integer_attribute(group + "/solids") : 0;
  const bool same_walls = walls == static_cast<std::int64_t>(parameters_.walls.size()),
             same_solids = solids == static_cast<std::int64_t>(parameters_.solids.size());
  if (!(same_walls && same_solids) && !as_start)
    throw InputError(
        fmt::format("The saved grains had {} walls and {} solids, but this case has {} and {}; both must be the same.",
                    walls, solids, parameters_.walls.size(), parameters_.solids.size()));
  global_count_ = static_cast<std::int64_t>(archive.shape(group + "/radius").at(0));
  // A start may be that of another kind of run, whose columns mean something else.
  const bool same_columns =
      what == Restored::whole || (what == Restored::start && has_columns(archive, group, store_.attached_width));
  GrainBatch batch =
      read_grains(archive, group, RowRange(global_count_, ranks, me), same_columns ? store_.attached_width : 0);
  if (!same_columns) batch.attached.assign(batch.rows.size() * store_.attached_width, 0.0);

  // A state saved before walls could move has no count, and no need of one.
  const bool timed = !as_start && archive.has(group + "/sub_steps");
  steps_done_ = timed ? archive.integer_attribute(group + "/sub_steps") : 0;
  if (timed && archive.has(group + "/time"))  // the sub-steps may be others now, the time is not
    steps_done_ = std::llround(archive.real_attribute(group + "/time") / parameters_.time_step);
  if (!as_start) assemblies_.load(archive, group);
  turnover_.set_first_id(global_count_);
  if (!as_start) load_turnover(archive, group);
  if (!archive.has(group + "/id") && id_limit() != global_count_)  // as save() has it
    throw damaged_dataset(group + "/id", "the file has no such data, but grains have come in or left");
  check_prescribed_speed();
  if (walls_change_) place_walls(time(), time());
  if (solids_change_) place_solids(time(), time());
  check_loaded(batch, GrainSpace(box_, planes_), communicator_);
  const bool stranger = std::any_of(batch.rows.begin(), batch.rows.end(), [this](const GrainRow& row) {
    return row.material < 0 || row.material >= materials_.count();
  });
  if (any_rank(communicator_, stranger))
    throw InputError(fmt::format("The saved grains are of more materials than this case has, {}.", materials_.count()));
  double largest = 0.0, largest_offset = 0.0;
  std::int64_t members = 0;
  for (const GrainRow& row : batch.rows) {
    largest = std::max(largest, row.radius);
    largest_offset = std::max(largest_offset, Vec3(row.offset.data()).norm());
    members += row.clump >= 0;
  }
  // Supplies bring grains like those of the start, which may all have left.
  largest_radius_ = std::max(turnover_.largest_radius(), max_over_ranks(communicator_, largest));
  largest_offset_ = std::max(turnover_.largest_offset(), max_over_ranks(communicator_, largest_offset));
  member_count_ = sum_over_ranks(communicator_, members);
  ghosts_ = GhostExchange(decomposition_, communicator_, ghost_reach(), largest_offset_);

  std::vector<int> owner;  // grains go to the rank of their centre
  for (GrainRow& row : batch.rows) {
    const Vec3 x = box_.wrapped(Vec3(row.value[GrainRow::position].data()));
    row.value[GrainRow::position] = {x[0], x[1], x[2]};
    owner.push_back(decomposition_.owner_of(x));
  }
  // Walls are known by their number, and solids come behind them.
  const std::int64_t known_walls = !same_walls   ? 0
                                   : same_solids ? walls + static_cast<std::int64_t>(touches_per_solid) * solids
                                                 : walls;
  const std::vector<Clump> clumps = load_clumps(archive, group, batch, owner);
  const ContactHistories histories = load_histories(archive, group, batch, owner, known_walls);

  replace_owned(store_, exchange_grains(communicator_, std::move(batch), owner, store_.attached_width));
  const std::vector<LightestGrain> lightest = lightest_of(store_, clumps, materials_.count(), communicator_);
  check_time_step(parameters_, lightest, body_count());
  check_lubrication(parameters_, lightest, largest_radius_, box_);
  clumps_.replace(clumps);
  build_dependents(histories);
  rebuilds_ = 0;
}

// The histories of the contacts of the grains that will be here, sorted by ids. batch, owner: the grains that this rank
// read, and their owners.
ContactHistories GrainDynamics::load_histories(ArchiveReader& archive, const std::string& group,
                                               const GrainBatch& batch, const std::vector<int>& owner,
                                               std::int64_t walls) {
  const Readers readers(batch, communicator_);
  constexpr int no_rank = -1;
  const auto sent_on = [&](const ContactHistories& histories, const auto& rank_for) {
    ContactHistories sent(histories.width());
    std::vector<int> to;
    for (std::size_t n = 0; n < histories.size(); ++n)
      for (const GlobalId id : {histories.key(n).first, histories.key(n).second})
        if (const int rank = id < 0 ? no_rank : rank_for(id); rank != no_rank) {
          sent.add(histories.key(n), histories.values(n));
          to.push_back(rank);
        }
    ContactHistories arrived = sent.exchanged(communicator_, to);
    arrived.sort();
    return arrived;
  };
  // First to the ranks that read one of its grains and so know the owner, then to the owners.
  const ContactHistories read = read_histories(archive, group, history_parts_of(list_), walls, communicator_);
  const ContactHistories met = sent_on(read, [&](GlobalId id) { return readers.rank_of(id); });
  return sent_on(met, [&](GlobalId id) {
    const std::optional<std::size_t> row = row_of(batch, id);
    return row ? owner[*row] : no_rank;
  });
}

// The clumps with their centre here. Members go to the rank of their clump's centre: `owner` of the rows of `batch` is
// set to it.
std::vector<Clump> GrainDynamics::load_clumps(ArchiveReader& archive, const std::string& group, const GrainBatch& batch,
                                              std::vector<int>& owner) {
  const int ranks = size_of(communicator_), me = rank_of(communicator_);
  clump_count_ = 0;
  if (!archive.has(group + "/clump_id")) return {};
  clump_count_ = static_cast<std::int64_t>(archive.shape(group + "/clump_id").at(0));
  // Every rank that read a member is told of the clump; the one that read the first member passes it on.
  const std::vector<ClumpRow> read = read_clumps(archive, group, RowRange(clump_count_, ranks, me));
  const Readers readers(batch, communicator_);
  std::vector<ClumpRow> sent;
  std::vector<int> to;
  for (const ClumpRow& row : read)
    for (int rank = readers.rank_of(row.id); rank <= readers.rank_of(row.id + row.members - 1); ++rank) {
      sent.push_back(row);
      to.push_back(rank);
    }
  std::vector<ClumpRow> passed;
  std::vector<int> destination;
  for (const ClumpRow& row : exchange_rows(communicator_, sent, to)) {
    const int centre_owner = decomposition_.owner_of(box_.wrapped(Vec3(row.centre)));
    for (GlobalId id = row.id; id < row.id + row.members; ++id)
      if (const std::optional<std::size_t> here = row_of(batch, id)) owner[*here] = centre_owner;
    if (!row_of(batch, row.id)) continue;
    passed.push_back(row);
    destination.push_back(centre_owner);
  }
  passed = exchange_rows(communicator_, passed, destination);
  std::sort(passed.begin(), passed.end(), [](const ClumpRow& a, const ClumpRow& b) { return a.id < b.id; });
  std::vector<Clump> clumps;
  for (const ClumpRow& row : passed) clumps.push_back(clump_of(row));
  return clumps;
}

}  // namespace thalweg::dem
