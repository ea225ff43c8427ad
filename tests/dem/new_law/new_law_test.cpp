// A contact law of a user, on a copy of dem/ that extend.py has extended: its key, and grains that stick to each other
// and to a floor.
#include "core/base/error.hpp"
#include "io/text/section_reader.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace thalweg::dem::new_law_test {
namespace {

struct ContactSection {
  ContactParameters contact;
  StiffnessKeys stiffness;
};
void describe(SectionVisitor& visit, ContactSection& section) {
  dem::describe(visit, section.contact, section.stiffness);
}

TEST(NewContactLaw, HasItsKey) {
  const testing::ScratchFolder scratch;
  const std::filesystem::path file = scratch / "case.yaml";
  std::ofstream(file) << "{restitution: 0.9, work_of_adhesion: 0.05}";
  ContactSection section;
  io::read_document(io::YamlDocument(file, {}), section);
  EXPECT_EQ(section.contact.work_of_adhesion, 0.05);
  EXPECT_THROW(io::read_document(io::YamlDocument(file, {"work_of_adhesion=-1"}), section), InputError);
}

GrainParameters with_adhesion(double work) {
  GrainParameters p = test::parameters(test::glass(0.3), 5e-6, 20);
  p.contact.work_of_adhesion = work;
  p.initial_overlap = 1e-3;
  return p;
}

TEST(NewContactLaw, IsTheSameForAllMaterials) {
  GrainParameters p = with_adhesion(0.5);
  p.other_materials = {test::glass(0.3)};
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.02, 0.02, 0.02))}),
               InputError);
}

// Without a load two spheres rest where k delta = 2 pi R w, R = R1/2.
TEST(NewContactLaw, HoldsTwoGrainsAtTheirBalance) {
  constexpr double work = 0.5, stiffness = 20000.0;
  const double balance = std::numbers::pi * test::glass_radius * work / stiffness;
  const Vec3 first(0.02, 0.02, 0.02), apart(2.0 * test::glass_radius - 0.5 * balance, 0.0, 0.0);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, with_adhesion(work),
                       {test::glass_sphere(0, first), test::glass_sphere(1, first + apart)});
  for (int n = 0; n < 100; ++n) test::step(grains);  // 0.01 s: fifty contact times, each with e = 0.3
  const std::vector<Contact> contacts = grains.contacts();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].overlap / balance, 1.0, 1e-6);
}

// A sphere hangs on a plane above it as long as its weight is below 2 pi R w.
TEST(NewContactLaw, HoldsAGrainOnAWallUpToItsPullOffForce) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass(), gravity = 9.8;
  const double work = mass * gravity / (2.0 * std::numbers::pi * test::glass_radius);  // J/m^2, at the limit
  for (const double factor : {0.98, 1.02}) {
    GrainParameters p = with_adhesion(factor * work);
    p.walls = {face_plane(test::cube().box(), 2, false, 0.5)};
    p.body_force = [gravity](double m, double) -> Vec3 { return {0.0, 0.0, m * gravity}; };
    // At the balance of springs, weight and adhesion, which is above the surface at 0.98.
    const double overlap = (factor - 1.0) * mass * gravity / p.contact.normal_stiffness;
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                         {test::glass_sphere(0, Vec3(0.02, 0.02, test::glass_radius - std::abs(overlap)))});
    for (int n = 0; n < 300; ++n) test::step(grains);  // 0.03 s
    const double height = grains.store().position[0].z() - test::glass_radius;
    if (factor > 1.0)
      EXPECT_NEAR(-height / overlap, 1.0, 1e-6);
    else  // free, it would be 0.5 g t^2 = 4.4 mm away
      EXPECT_GT(height, 1e-3);
  }
}

}  // namespace
}  // namespace thalweg::dem::new_law_test
