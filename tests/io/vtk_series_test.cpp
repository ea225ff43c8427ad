// Writes both ParaView series, interrupted and continued, into vtk_<ranks>/ beside the test; check_vtk_series.py then
// opens them with VTK's own readers. Here: what the index files keep, and the errors.
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/vtk/fluid_series.hpp"
#include "io/vtk/grain_series.hpp"
#include "io/vtk/solid_series.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace thalweg::io::vtk_series_test {
namespace {

using testing::contents;
using testing::message_of;
using testing::ScratchFolder;

constexpr Index3 cells{24, 20, 18};  // more than the two blocks of a file
constexpr double spacing = 0.25e-3;  // m
constexpr std::int64_t grain_count = 9001;
const PopulationIds ends{{4000, grain_count}, {}};

// Fields that tell every cell apart; check_vtk_series.py computes the same.
class CellNumbers final : public FluidSource {
public:
  CellNumbers(Block block, double time) : block_(block), time_(time) {}
  FluidFields sample(const std::vector<FluidField>&, const Block& region) const override {
    FluidFields fields;
    fields.block = intersection(block_, region);
    for (int k = fields.block.lower[2]; k < fields.block.upper[2]; ++k)
      for (int j = fields.block.lower[1]; j < fields.block.upper[1]; ++j)
        for (int i = fields.block.lower[0]; i < fields.block.upper[0]; ++i) {
          for (const int c : {i, j, k}) fields.velocity.push_back(c + 0.5);
          fields.pressure.push_back(i + 100 * j + 10000 * k + time_);
          fields.grain_id.push_back((i + j + k) % 5 - 1);
        }
    return fields;
  }

  void for_each_velocity(const VelocityVisitor&) const override {}
  std::optional<State> state_in(const Index3&) const override { return std::nullopt; }

private:
  Block block_;
  double time_;
};

// Grain n is owned by rank n % ranks, listed backwards.
struct Grains {
  std::vector<GlobalId> id;
  std::vector<double> radius, mass;
  std::vector<std::uint8_t> motion;
  std::vector<Vec3> position, velocity, angular_velocity, fluid_force, fluid_torque, contact_force;
  std::vector<Mat3> fluid_stress;

  explicit Grains(double time) {
    for (std::int64_t n = grain_count - 1; n >= 0; --n) {
      if (n % size_of(MPI_COMM_WORLD) != rank_of(MPI_COMM_WORLD)) continue;
      const auto x = static_cast<double>(n);
      id.push_back(n);
      radius.push_back(1e-3 + 1e-5 * x);
      mass.push_back(1.0);
      motion.push_back(static_cast<std::uint8_t>(n % 8));
      position.emplace_back(0.1 * x, 0.2 * x, 0.3 * x + time);
      velocity.emplace_back(3.0 * x, 4.0 * x, 0.0);
      angular_velocity.emplace_back(x, 0.0, -x);
      fluid_force.emplace_back(0.0, x, 1.0);
      fluid_torque.emplace_back(0.0, 0.0, 0.0);
      contact_force.emplace_back(1.0, 2.0, x);
      Mat3 stress;
      stress << x, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0;
      fluid_stress.push_back(stress);
    }
  }
  GrainView view(bool with_fluid) const {
    GrainView view;
    view.global_count = grain_count;
    view.id = id;
    view.radius = radius;
    view.mass = mass;
    view.motion = motion;
    view.position = position;
    view.velocity = velocity;
    view.angular_velocity = angular_velocity;
    view.contact_force = contact_force;
    if (with_fluid) {
      view.fluid_force = fluid_force;
      view.fluid_torque = fluid_torque;
    }
    return view;
  }
};

// Every grain has one contact at the end of its radius along x, with the force (-1, 0, id) N.
class Pressed : public ContactSource {
public:
  explicit Pressed(const GrainView& grains) : grains_(grains) {}
  void for_each_contact(const ContactVisitor& visit) const override {
    for (std::size_t i = 0; i < grains_.id.size(); ++i)
      visit(i, Vec3(grains_.radius[i], 0.0, 0.0), Vec3(-1.0, 0.0, static_cast<double>(grains_.id[i])));
  }
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    for_each_contact([&](std::size_t i, const Vec3& arm, const Vec3& force) {
      if (chosen[i] != 0) visit(i, {arm, force, -1, arm});
    });
  }

private:
  const GrainView& grains_;
};

class Pictures {
public:
  explicit Pictures(const std::filesystem::path& folder) : folder_(folder) {}

  // One picture of every series at time `step` * 0.1 s.
  void write(std::int64_t step, std::optional<double> continue_from) {
    const double time = 0.1 * static_cast<double>(step);
    const Decomposition decomposition(cells, spacing, {true, true, false},
                                      Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
    const CellNumbers fluid(decomposition.block_of(rank_of(MPI_COMM_WORLD)), time);
    const Grains grains(time);
    Snapshot snapshot{time, step, &decomposition, grains.view(true), &fluid};

    series<GrainSeries>("wet", continue_from, snapshot, std::string("grains"), GrainSelectionKeys{},
                        std::vector<GrainField>{}, ends);
    snapshot.grains.fluid_stress = grains.fluid_stress;
    const Pressed pressed(snapshot.grains);
    snapshot.contacts = &pressed;
    series<GrainSeries>("stressed", continue_from, snapshot, std::string("grains"), GrainSelectionKeys{},
                        std::vector<GrainField>{}, ends);
    write_grain_parts(continue_from, snapshot);
    write_solids(continue_from, snapshot);
    snapshot.contacts = nullptr;
    series<FluidSeries>("whole", continue_from, snapshot, std::string("fluid"),
                        FluidRegionKeys{FluidRegion::whole, {}, {}, 1},
                        std::vector<FluidField>{FluidField::velocity, FluidField::pressure, FluidField::grain_id},
                        FieldPrecision::single);
    series<FluidSeries>("slice_x", continue_from, snapshot, std::string("fluid"),
                        FluidRegionKeys{FluidRegion::slice_x, {}, {}, 1}, std::vector<FluidField>{FluidField::velocity},
                        FieldPrecision::single);
    series<FluidSeries>("slice_y", continue_from, snapshot, std::string("fluid"),
                        FluidRegionKeys{FluidRegion::slice_y, {}, {}, 1},
                        std::vector<FluidField>{FluidField::pressure, FluidField::velocity}, FieldPrecision::single);
    series<FluidSeries>("slice_z", continue_from, snapshot, std::string("fluid"),
                        FluidRegionKeys{FluidRegion::slice_z, {}, {}, 1}, std::vector<FluidField>{FluidField::grain_id},
                        FieldPrecision::single);
    // Cells 4 to 20 along x, 5 to 19 along y, 3 to 8 along z, every third of them.
    FluidRegionKeys sparse{FluidRegion::whole, BoxKeys{{1.1e-3, 1.375e-3, 0.8e-3}, {5.2e-3, 5e-3, 2.2e-3}}, {}, 3};
    series<FluidSeries>("sparse", continue_from, snapshot, std::string("fluid"), sparse,
                        std::vector<FluidField>{FluidField::velocity, FluidField::grain_id}, FieldPrecision::single);
    FluidRegionKeys plane{FluidRegion::whole, {}, FluidPlaneKeys{Axis::z, 2.6e-3}, 4};  // layer 10
    series<FluidSeries>("plane", continue_from, snapshot, std::string("fluid"), plane,
                        std::vector<FluidField>{FluidField::pressure}, FieldPrecision::single);
    series<FluidSeries>("precise", continue_from, snapshot, std::string("fluid"),
                        FluidRegionKeys{FluidRegion::slice_z, {}, {}, 1},
                        std::vector<FluidField>{FluidField::pressure, FluidField::grain_id}, FieldPrecision::double_);
    snapshot.grains = grains.view(false);
    series<GrainSeries>("dry", continue_from, snapshot, std::string("grains"), GrainSelectionKeys{},
                        std::vector<GrainField>{}, ends);
    snapshot.fluid = nullptr;
    series<FluidSeries>("without_fluid", continue_from, snapshot, std::string("fluid"),
                        FluidRegionKeys{FluidRegion::whole, {}, {}, 1}, std::vector<FluidField>{FluidField::pressure},
                        FieldPrecision::single);
  }

private:
  void write_grain_parts(std::optional<double> continue_from, const Snapshot& snapshot) {
    const auto part = [&](const std::string& name, const GrainSelectionKeys& selection,
                          const std::vector<GrainField>& fields) {
      series<GrainSeries>(name, continue_from, snapshot, std::string("part"), selection, fields, ends);
    };
    part("some", {{9000, 7, 4096, 0}, {}, {}}, {});
    part("second", {{}, 1, {}}, {GrainField::population, GrainField::id});
    // Grains 3 to 7 at first, and fewer as they rise.
    part("boxed", {{}, {}, BoxKeys{{0.25, 0.5, 0.0}, {10.0, 10.0, 2.25}}}, {GrainField::held, GrainField::id});
    part("nobody", {{1}, 1, {}}, {GrainField::velocity});
  }
  // A strip of triangles, and one alone; more than the block of a file.
  void write_solids(std::optional<double> continue_from, const Snapshot& snapshot) {
    TriangleMesh strip, alone{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, snapshot.time}}, {{0, 1, 2}}};
    for (int n = 0; n < 5002; ++n) strip.points.emplace_back(0.5 * n, n % 2, snapshot.time);
    for (int n = 0; n < 5000; ++n) strip.triangles.push_back({n, n + 1, n + 2});
    const auto folder = folder_ / "solid";
    if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::create_directories(folder);
    SolidSeries(MPI_COMM_WORLD, folder, continue_from).write(snapshot.time, snapshot.step, {strip, alone});
  }
  template <typename Series, typename... Options>
  void series(const std::string& name, std::optional<double> continue_from, const Snapshot& snapshot,
              const Options&... options) {
    const auto folder = folder_ / name;
    if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::create_directories(folder);
    Series(MPI_COMM_WORLD, folder, options..., continue_from).write(snapshot);
  }
  std::filesystem::path folder_;
};

TEST(VtkSeries, WritesAnInterruptedAndContinuedSeries) {
  const std::filesystem::path folder = fmt::format("scratch/vtk_{}", size_of(MPI_COMM_WORLD));
  if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove_all(folder);
  MPI_Barrier(MPI_COMM_WORLD);
  Pictures pictures(folder);
  pictures.write(3, std::nullopt);  // of an older run: a new series forgets it
  pictures.write(0, std::nullopt);
  pictures.write(2, 0.0);
  pictures.write(9, 0.5);  // the run then stops, and is continued from a checkpoint at 0.5 s:
  pictures.write(7, 0.5);  // the picture at 0.9 s is removed
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const PvdIndex index(MPI_COMM_SELF, folder / "wet/grains.pvd", 100.0);
  ASSERT_EQ(index.entries().size(), 3u);
  EXPECT_EQ(index.entries()[1].time, 0.1 * 2.0);  // the same bits as written
  EXPECT_EQ(index.entries()[2].file, "grains/grains_000000007.vtp");
  EXPECT_FALSE(std::filesystem::exists(folder / "without_fluid/fluid.pvd"));
}

// Solids at 0, 0.1, ..., 0.9 s.
void write_frames(const std::filesystem::path& folder) {
  SolidSeries series(MPI_COMM_WORLD, folder);
  const TriangleMesh one{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, {{0, 1, 2}}};
  for (int step = 0; step < 10; ++step) series.write(0.1 * step, step, {one});
  series.put_on_disk();
}

// Appending leaves the same file as writing it at once, valid XML at its end.
TEST(PvdIndex, IsTheSameAppendedAsTakenUp) {
  const ScratchFolder folder;
  write_frames(folder.path());
  const std::string appended = contents(folder / "solids.pvd");
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_TRUE(appended.ends_with("file=\"solids/solids_000000009.vtp\"/>\n  </Collection>\n</VTKFile>\n"));
  PvdIndex again(MPI_COMM_WORLD, folder / "solids.pvd", 0.9);
  EXPECT_EQ(contents(folder / "solids.pvd"), appended);
}

// Cut anywhere, as by a kill within a write, or gone: a restart makes it from the frames.
TEST(PvdIndex, IsRestoredFromTheFrames) {
  const ScratchFolder folder;
  write_frames(folder.path());
  const auto path = folder / "solids.pvd";
  const std::string whole = contents(path);
  const bool first = rank_of(MPI_COMM_WORLD) == 0;
  const auto expect_restored = [&](const std::string& damaged) {
    MPI_Barrier(MPI_COMM_WORLD);
    if (first) testing::put(path, damaged);
    PvdIndex(MPI_COMM_WORLD, path, 1.0);
    EXPECT_EQ(contents(path), whole) << damaged;
  };
  for (std::size_t size = 0; size < whole.size(); size += 37) expect_restored(whole.substr(0, size));
  std::string hole = whole;
  hole.replace(300, 200, 200, ' ');
  expect_restored(hole);
  expect_restored(whole.substr(0, 400) + whole.substr(whole.size() - 30));  // the tail behind half an entry
  MPI_Barrier(MPI_COMM_WORLD);
  if (first) std::filesystem::remove(path);
  PvdIndex(MPI_COMM_WORLD, path, 1.0);
  EXPECT_EQ(contents(path), whole);
}

TEST(PvdIndex, DropsLaterFramesAndUnfinishedOnes) {
  const ScratchFolder folder;
  write_frames(folder.path());
  if (rank_of(MPI_COMM_WORLD) == 0) {
    std::filesystem::remove(folder / "solids.pvd");  // the frames themselves know
    testing::put(folder / "solids/solids_000000010.vtp.partial", "half");
    testing::put(folder / "solids/solids_000000010.vtp.partial.locktest.1", "of MPI-IO");
    testing::put(folder / "solids/mine.vtp", "somebody else's");
  }
  PvdIndex index(MPI_COMM_WORLD, folder / "solids.pvd", 0.4);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_EQ(index.entries().size(), 5u);
    EXPECT_TRUE(std::filesystem::exists(folder / "solids/solids_000000004.vtp"));
    EXPECT_FALSE(std::filesystem::exists(folder / "solids/solids_000000005.vtp"));
    EXPECT_FALSE(std::filesystem::exists(folder / "solids/solids_000000010.vtp.partial"));
    EXPECT_FALSE(std::filesystem::exists(folder / "solids/solids_000000010.vtp.partial.locktest.1"));
    EXPECT_TRUE(std::filesystem::exists(folder / "solids/mine.vtp"));
  }
}

TEST(PvdIndex, OfSomebodyElseIsLeftAlone) {
  const ScratchFolder folder;
  write_frames(folder.path());
  const std::string mine = "<DataSet timestep=\"9\" group=\"a\" file=\"solids/solids_000000009.vtp\"/>";
  if (rank_of(MPI_COMM_WORLD) == 0) testing::put(folder / "mine.pvd", mine);
  MPI_Barrier(MPI_COMM_WORLD);
  take_up_indices(MPI_COMM_WORLD, folder.path(), 0.2);
  EXPECT_EQ(contents(folder / "mine.pvd"), mine);
  EXPECT_FALSE(std::filesystem::exists(folder / "solids/solids_000000003.vtp"));
}

// Somebody has changed or removed it meanwhile.
TEST(PvdIndex, IsWrittenAnewWhereItIsNotWhatItWas) {
  const ScratchFolder folder;
  PvdIndex index(MPI_COMM_WORLD, folder / "solids.pvd", std::nullopt);
  for (int step = 0; step < 3; ++step) {
    index.add(0.1 * step, "solids/a.vtp");
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of(MPI_COMM_WORLD) == 0 && step == 0) testing::put(folder / "solids.pvd", "changed");
    if (rank_of(MPI_COMM_WORLD) == 0 && step == 1) std::filesystem::remove(folder / "solids.pvd");
    MPI_Barrier(MPI_COMM_WORLD);
  }
  const std::string text = contents(folder / "solids.pvd");
  for (const char* time : {"\"0\"", "\"0.1\"", "\"0.2\""}) EXPECT_NE(text.find(time), std::string::npos) << text;
}

TEST(VtkSeries, AFolderThatCannotBeWrittenIsARunErrorOnEveryRank) {
  const ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) == 0) {
    testing::put(folder / "grains", "a file where the folder should be");
    testing::put(folder / "fluid", "a file where the folder should be");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const Decomposition decomposition(cells, spacing, {true, true, false},
                                    Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  const CellNumbers fluid(decomposition.block_of(rank_of(MPI_COMM_WORLD)), 0.0);
  const Grains grains(0.0);
  const Snapshot snapshot{0.0, 0, &decomposition, grains.view(true), &fluid};
  EXPECT_NE(message_of<RunError>([&] {
              GrainSeries(MPI_COMM_WORLD, folder.path(), "grains", {}, {}, {{grain_count}, {}}).write(snapshot);
            }),
            "");
  EXPECT_NE(message_of<RunError>([&] {
              FluidSeries(MPI_COMM_WORLD, folder.path(), "fluid", {}, {FluidField::pressure}, FieldPrecision::single)
                  .write(snapshot);
            }),
            "");
}

}  // namespace
}  // namespace thalweg::io::vtk_series_test
