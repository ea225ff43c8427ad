#include "driver/setup/initial_state.hpp"

#include "beds/population_rows.hpp"
#include "core/base/error.hpp"
#include "core/base/round_off.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "core/parallel/row_range.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/setup/checkpoint_file.hpp"
#include "io/folder/run_folder.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

// Does something with the source of a field, if there is one, so that an InputError names its key. The first rank looks
// which checkpoint that is.
template <typename Work>
void about_source(const Case& c, InitialField field, MPI_Comm communicator, Work&& work) {
  const InitialSource source = c.initial.source_of(field);
  if (source.path.empty()) return;
  try {
    work(std::filesystem::path(
        told_by_first_rank(communicator, [&] { return io::checkpoint_at(source.path).string(); })));
  } catch (const InputError& error) {
    std::string reason = error.what();
    if (const std::string again = source.path + ": "; reason.starts_with(again)) reason.erase(0, again.size());
    throw InputError(fmt::format("{} = {}: {}", source.key, source.path, reason));
  }
}

void refuse_state_without(InitialField field, const io::Hdf5Reader& archive, const std::filesystem::path& path) {
  if (field == InitialField::grains && !archive.has("grains/radius"))
    throw InputError(fmt::format("{} holds no grains; give a run with system: resolved or grains.", path.string()));
  if (field == InitialField::fluid && !archive.has("fluid/populations_00"))
    throw InputError(fmt::format("{} holds no fluid; give a run with system: resolved or fluid.", path.string()));
}

// Rounding of a density or diameter on its way through files.
constexpr double same_grain = 1e-9;

bool differ(double one, double other) { return !(std::abs(one - other) <= same_grain * std::abs(other)); }

// Some grains of the state, one row each.
struct SavedGrains {
  std::vector<double> radius, mass;
  std::vector<std::int64_t> motion, material;
};

SavedGrains saved_grains(io::Hdf5Reader& archive, const RowRange& share) {
  const auto rows = static_cast<std::size_t>(share.size());
  SavedGrains saved{std::vector<double>(rows), std::vector<double>(rows), std::vector<std::int64_t>(rows),
                    std::vector<std::int64_t>(rows)};
  archive.read("grains/radius", saved.radius, share.box());
  archive.read("grains/mass", saved.mass, share.box());
  archive.read("grains/motion", saved.motion, share.box());
  archive.read("grains/material", saved.material, share.box());
  return saved;
}

// Difference between a grain of the state and its row in the case; empty if there is none.
std::string difference(const SavedGrains& saved, std::size_t n, const beds::PopulationRow& here) {
  if (differ(saved.radius[n], here.radius))
    return fmt::format("a diameter of {:.6g} m and here of {:.6g} m", 2.0 * saved.radius[n], 2.0 * here.radius);
  if (here.mass > 0.0 && differ(saved.mass[n], here.mass))
    return fmt::format("a mass of {:.6g} kg and here of {:.6g} kg", saved.mass[n], here.mass);
  if (saved.motion[n] != static_cast<std::int64_t>(here.motion))
    return "another motion (free, fixed or prescribed) than here";
  if (saved.material[n] != here.material) return "another material (contact) than here";
  return {};
}

// share: of the rows of a population, the first of which is row `first` of the state.
void refuse_other_rows(const Case& c, std::size_t population, RowRange share, std::int64_t first,
                       io::Hdf5Reader& archive) {
  const std::vector<beds::PopulationRow> rows = beds::rows_of(c.grains, population, share);
  share.count = grain_rows(c);
  share.first += first;
  share.last += first;
  const SavedGrains saved = saved_grains(archive, share);
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (const std::string what = difference(saved, n, rows[n]); !what.empty())
      throw InputError(
          fmt::format("Grain {} has {} (grains.{}). Grains that are taken over stay as they are: give "
                      "the populations of that run (its case.yaml has them), or take the bed.h5 in its "
                      "folder as placement.file.",
                      share.first + static_cast<std::int64_t>(n), what, population));
}

// Grains that touch across the end of a periodic box would overlap in a shorter one, and lose their neighbours in a
// longer one or at a wall.
void refuse_other_periods(const Case& c, const io::Hdf5Reader& archive) {
  const PeriodicBox box = grain_box(c);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!archive.has(saved_period(axis)) || (c.disks && axis == 1)) continue;
    const double made = archive.real_attribute(saved_period(axis)), here = box.size[static_cast<int>(axis)];
    if (made == 0.0 || (box.periodic[axis] && same_but_for_rounding(made, here))) continue;
    throw InputError(
        fmt::format("Its box is periodic along {} over {:g} m, and this case's is {} over {:g} m; give the "
                    "same domain there, or make a bed for this one.",
                    "xyz"[axis], made, box.periodic[axis] ? "periodic" : "not periodic", here));
  }
}

// Grains stay what they were, whatever the case says of them: then q* and the Shields number of the run, and all that
// `thalweg check` says, would be those of other grains. Each rank compares its share of the rows.
void refuse_other_grains(const Case& c, const std::filesystem::path& path, const Ranks& ranks) {
  if (std::any_of(c.grains.begin(), c.grains.end(), [](const beds::Population& grains) { return grains.motion; }))
    throw InputError("A case with rigid populations (motion) cannot take over grains; give their placements instead.");
  ranks.on_all([&] {
    io::Hdf5Reader archive(path);
    refuse_other_periods(c, archive);
    const auto rows = static_cast<std::int64_t>(archive.shape("grains/radius").at(0));
    if (rows != grain_rows(c))
      throw InputError(fmt::format("There are {} grains, but this case has {}; give populations with as many.", rows,
                                   grain_rows(c)));
  });
  std::int64_t first = 0;
  for (std::size_t population = 0; population < c.grains.size(); ++population) {
    const RowRange share = beds::share_of_rows(c.grains[population], ranks);
    ranks.on_all([&] {
      io::Hdf5Reader archive(path);
      refuse_other_rows(c, population, share, first, archive);
    });
    first += c.grains[population].row_count();
  }
}

}  // namespace

void check_initial_sources(const Case& c, const Ranks& ranks) {
  for (const InitialField field : {InitialField::grains, InitialField::fluid})
    about_source(c, field, ranks.communicator(), [&](const std::filesystem::path& path) {
      ranks.on_all([&] { refuse_state_without(field, io::Hdf5Reader(path), path); });
      if (field == InitialField::grains) refuse_other_grains(c, path, ranks);
    });
}

std::filesystem::path initial_grains(const Case& c, MPI_Comm communicator) {
  std::filesystem::path state;
  about_source(c, InitialField::grains, communicator, [&](const std::filesystem::path& path) { state = path; });
  return state;
}

void take_initial_fields(MPI_Comm communicator, const Case& c, System& system) {
  // The fluid last: what it is taken for depends on where the grains are.
  for (const InitialField field : {InitialField::grains, InitialField::fluid})
    about_source(c, field, communicator, [&](const std::filesystem::path& path) {
      io::Hdf5Reader archive(communicator, path);
      refuse_state_without(field, archive, path);
      require_checksums(archive);
      const double spacing = archive.real_attribute("run/spacing");
      if (field == InitialField::grains)
        system.import_grains(archive, spacing);
      else
        system.import_fluid(archive, spacing);
    });
}

}  // namespace thalweg::driver
