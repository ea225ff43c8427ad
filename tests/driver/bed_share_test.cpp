// Bed files that ranks read together, each its share: what follows from all rows, grains and refusals are those of one
// process that reads the whole.
#include "core/base/error.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/setup/bed_archive.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::driver::bed_share_test {
namespace {

using testing::put;
using testing::ScratchFolder;

// A grain before the bed, the bed, and grains that are to keep clear of it.
const std::string text = R"(system: grains
name: beds
domain:
  size: [0.06, 0.04, 0.06]
  spacing: 2.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8, slope: 0.0}
grains:
  - {diameter: 4.0e-3, density: 2000, placement: {positions: [[0.03, 0.02, 0.055]]}}
  - {placement: {file: bed.h5}}
  - {count: 30, diameter: 4.0e-3, density: 2550, placement: {pattern: random, seed: 3}}
contact: {restitution: 0.4}
run: {until: 1.0e-3}
)";

// Rows on a cubic lattice from the floor up: spheres of two sizes and, at every third site, a clump of three in 5 mm,
// some of them across a periodic face. The middle of the rows is within a clump.
std::vector<BedGrain> rows_of_bed() {
  constexpr double spacing = 5e-3;
  const PeriodicBox box{{0.06, 0.04, 0.06}, {true, true, false}};
  std::vector<BedGrain> rows;
  for (int site = 0; site < 382; ++site) {
    const Vec3 centre = spacing * Vec3(site % 12, site / 12 % 8 + 0.5, site / 96 + 0.5);
    const auto first = static_cast<GlobalId>(rows.size());
    BedGrain row;
    row.id = first;
    row.radius = site % 2 == 0 ? 2.5e-3 : 2e-3;
    row.density = 2550.0 + site % 4;
    row.position = centre;
    row.velocity.x() = 0.01 * site;
    if (site % 3 != 1) {
      rows.push_back(row);
      continue;
    }
    row.radius = 1.5e-3;
    row.clump = first;
    for (const int place : {-1, 0, 1}) {
      row.position = box.wrapped(centre + Vec3(1e-3 * place, 0.0, 0.0));
      rows.push_back(row);
      ++row.id;
    }
  }
  return rows;
}

void write_bed(const std::filesystem::path& path, const std::vector<BedGrain>& rows) {
  std::vector<std::int64_t> id, clump;
  std::vector<double> radius, density, position, velocity, spin(3 * rows.size(), 0.0);
  for (const BedGrain& row : rows) {
    id.push_back(row.id);
    clump.push_back(row.clump);
    radius.push_back(row.radius);
    density.push_back(row.density);
    position.insert(position.end(), row.position.data(), row.position.data() + 3);
    velocity.insert(velocity.end(), row.velocity.data(), row.velocity.data() + 3);
  }
  const std::vector<double> size{0.06, 0.04, 0.06};
  const std::vector<std::int64_t> periodic{1, 1, 0};
  const RowRange all(static_cast<std::int64_t>(rows.size()), 1, 0), three(3, 1, 0);
  io::Hdf5Writer file(MPI_COMM_SELF, path);
  file.attribute("bed/format", std::string("thalweg bed 1"));
  file.attribute("bed/time", 0.0);
  file.attribute("bed/disk_thickness", 0.0);
  file.write("bed/box", size, three.box());
  file.write("bed/periodic", periodic, three.box());
  file.write("grains/id", id, all.box());
  file.write("grains/clump", clump, all.box());
  file.write("grains/radius", radius, all.box());
  file.write("grains/density", density, all.box());
  file.write("grains/position", position, all.box(3));
  file.write("grains/velocity", velocity, all.box(3));
  file.write("grains/angular_velocity", spin, all.box(3));
  file.close();
}

class BedShare : public ::testing::Test {
protected:
  void write(const std::vector<BedGrain>& rows) {
    if (rank_of(MPI_COMM_WORLD) == 0) {
      put(folder_ / "case.yaml", text);
      write_bed(folder_ / "bed.h5", rows);
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }
  Case read_whole() const { return read_case(folder_ / "case.yaml"); }
  Case read_together() const { return read_case(folder_ / "case.yaml", {}, {}, MPI_COMM_WORLD); }

  // Compares the refusals of a bed that does not fit.
  void expect_the_same_refusal(const std::vector<std::string>& words) {
    std::string whole = "nothing", together = "nothing";
    try {
      read_whole();
    } catch (const InputError& error) {
      whole = error.what();
    }
    try {
      read_together();
    } catch (const InputError& error) {
      together = error.what();
    }
    EXPECT_EQ(together, whole);
    for (const std::string& word : words) EXPECT_NE(together.find(word), std::string::npos) << word << ": " << together;
  }

  ScratchFolder folder_;
};

TEST_F(BedShare, HasTheFiguresOfTheWhole) {
  const std::vector<BedGrain> rows = rows_of_bed();
  ASSERT_EQ(rows.size(), 636u);
  ASSERT_EQ(rows[318].clump, rows[317].clump);  // cut by two even shares
  write(rows);
  const Case whole = read_whole(), together = read_together();
  const beds::Population &all = whole.grains[1], &bed = together.grains[1];
  EXPECT_EQ(bed.figures, all.figures);
  EXPECT_EQ(bed.clumps, all.clumps);
  EXPECT_EQ(bed.count, 382);
  EXPECT_EQ(bed.diameter, all.diameter);
  EXPECT_EQ(bed.density, all.density);
  ASSERT_EQ(all.file.size(), rows.size());

  const auto share = static_cast<std::int64_t>(bed.file.size());
  EXPECT_EQ(sum_over_ranks(MPI_COMM_WORLD, share), 636);
  EXPECT_LE(share, 636 / size_of(MPI_COMM_WORLD) + 3);
  ASSERT_FALSE(bed.file.empty());
  const auto first = static_cast<std::size_t>(bed.file.front().id);
  EXPECT_TRUE(std::equal(bed.file.begin(), bed.file.end(), all.file.begin() + static_cast<std::ptrdiff_t>(first)));
  if (first > 0 && bed.file.front().clump >= 0) {
    EXPECT_NE(all.file[first - 1].clump, bed.file.front().clump);
  }

  EXPECT_EQ(bed.figures.smallest_diameter, 3e-3);
  EXPECT_EQ(bed.figures.largest_diameter, 5e-3);
  EXPECT_EQ(bed.figures.fastest, 3.81);
}

TEST_F(BedShare, BeginsWithTheSameGrains) {
  write(rows_of_bed());
  const Case together = read_together();
  const dem::GrainSeeds all = grain_seeds(read_whole());
  const Index3 cells = cells_of(together.domain);
  const Decomposition decomposition(cells, together.domain.spacing, periodic_axes(together.domain),
                                    Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  const dem::GrainSeeds mine = grain_seeds(together, MPI_COMM_WORLD, decomposition);
  const double reach = (1.0 + dem::allowed_initial_overlap) * largest_extent(together);
  const auto knows = [&](const Vec3& centre) {
    return decomposition.reaches(rank_of(MPI_COMM_WORLD), decomposition.box().wrapped(centre), reach);
  };
  std::size_t next = 0;
  for (const dem::GrainSeed& grain : all.grains) {
    if (!knows(grain.position)) continue;
    ASSERT_LT(next, mine.grains.size());
    const dem::GrainSeed& found = mine.grains[next++];
    EXPECT_EQ(found.id, grain.id);
    EXPECT_EQ(found.position, grain.position);
    EXPECT_EQ(found.velocity, grain.velocity);
    EXPECT_EQ(found.radius, grain.radius);
    EXPECT_EQ(found.density, grain.density);
  }
  EXPECT_EQ(next, mine.grains.size());
  next = 0;
  for (const dem::ClumpSeed& clump : all.clumps) {
    if (!knows(clump.position)) continue;
    ASSERT_LT(next, mine.clumps.size());
    const dem::ClumpSeed& found = mine.clumps[next++];
    EXPECT_EQ(found.id, clump.id);
    EXPECT_EQ(found.position, clump.position);
    EXPECT_EQ(found.mass(), clump.mass());
    ASSERT_EQ(found.shape->members.size(), 3u);
  }
  EXPECT_EQ(next, mine.clumps.size());
}

// A supply brings grains of one density, and would have brought those of the mean.
TEST_F(BedShare, IsNoSupplyWithSeveralDensities) {
  std::vector<BedGrain> rows = rows_of_bed();
  std::erase_if(rows, [](const BedGrain& row) { return row.clump >= 0; });
  for (std::size_t n = 0; n < rows.size(); ++n) rows[n].id = static_cast<GlobalId>(n);
  const auto read = [&] {
    return read_case(folder_ / "case.yaml",
                     {"supplies=[{population: 1, rate: 10, region: {lower: [0, 0, 0.03], upper: [0.06, 0.04, 0.05]}}]"},
                     {}, MPI_COMM_WORLD);
  };
  write(rows);
  const std::string message = testing::message_of<InputError>(read);
  EXPECT_NE(message.find("densities from 2550 to 2553 kg/m^3"), std::string::npos) << message;
  for (BedGrain& row : rows) row.density = 2550.0;
  write(rows);
  EXPECT_NO_THROW(read());
}

TEST_F(BedShare, IsTheSameFromACheckpoint) {
  write(rows_of_bed());
  const Case begun = read_together();
  const std::filesystem::path state = folder_ / "state.h5";
  io::Hdf5Writer archive(MPI_COMM_WORLD, state);
  save_beds(archive, MPI_COMM_WORLD, begun);
  archive.close();
  if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove(folder_ / "bed.h5");
  MPI_Barrier(MPI_COMM_WORLD);
  const Case again = read_case(folder_ / "case.yaml", {}, beds_of({state}), MPI_COMM_WORLD);
  const Case whole = read_case(folder_ / "case.yaml", {}, beds_of({state}));
  EXPECT_EQ(again.grains[1].figures, whole.grains[1].figures);
  EXPECT_GT(begun.grains[1].figures.fastest, 0.0);  // which goes on without the velocities
  EXPECT_EQ(again.grains[1].figures.fastest, begun.grains[1].figures.fastest);
  EXPECT_EQ(whole.grains[1].file.size(), 636u);
  std::vector<BedGrain> rows = begun.grains[1].file;
  for (BedGrain& row : rows) row.velocity.setZero();
  EXPECT_EQ(again.grains[1].file, rows);
}

TEST_F(BedShare, IsRefusedForAnOverlapOfTwoShares) {
  std::vector<BedGrain> rows = rows_of_bed();
  rows.back().position = rows.front().position + Vec3(-2e-3, 0.0, 0.0);  // across the periodic face
  rows.back().position.x() += 0.06;
  rows[400].position = rows[100].position;  // a pair of higher numbers
  write(rows);
  expect_the_same_refusal({"grains.1.placement.file", "Grain 0 at", "grain 635 at", "overlap by",
                           "up to placement.largest_overlap: 0.01 diameters are allowed"});
}

TEST_F(BedShare, IsRefusedForAGrainOutsideInTheLast) {
  std::vector<BedGrain> rows = rows_of_bed();
  rows[634].position.z() = 0.07;
  rows[635].position.z() = 0.08;
  write(rows);
  expect_the_same_refusal({"grains.1.placement.file", "grain 634 of the file", "outside this case's box"});
}

// As in the bed of a run whose floor has moved down: no size of the box holds it.
TEST_F(BedShare, IsRefusedForAGrainBelowTheBox) {
  std::vector<BedGrain> rows = rows_of_bed();
  rows[634].position.z() = -1e-3;
  write(rows);
  expect_the_same_refusal({"grains.1.placement.file", "grain 634 of the file",
                           "outside this case's box; give a "
                           "placement.region to leave it out"});
}

TEST_F(BedShare, IsRefusedWhereThereIsNone) {
  write({});
  expect_the_same_refusal({"no grain in the region"});
}

}  // namespace
}  // namespace thalweg::driver::bed_share_test
