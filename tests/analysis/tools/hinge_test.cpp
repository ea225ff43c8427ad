// The hinge of a sphere in a pocket and the torques about it, against the statics of a rigid body.
#include "analysis/observers/entrainment_event.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::hinge_test {
namespace {

// A grain on two downstream grains (1 and 2) and one upstream (3), contacts at a = 0.2 m downstream or twice that
// upstream and h = 0.8 m below its centre; the wall is at its side.
constexpr double a = 0.2, b = 0.5, h = 0.8;
const Vec3 centre(3.0, 2.0, 5.0);
const Touch one{1, {a, b, -h}, {-1.0, -2.0, 4.0}, 2.0}, two{2, {a, -b, -h}, {-1.0, 2.0, 4.0}, 2.0};
const Touch three{3, {-2.0 * a, 0.0, -h}, {1.0, 0.0, 2.0}, 2.0}, wall{-2, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}, 1.0};

GrainSample sample(double time, double speed, std::vector<Touch> touches, const Vec3& moved = Vec3::Zero(),
                   const Vec3& force = Vec3(2.0, 0.0, 0.5), const Vec3& couple = Vec3(0.3, 0.6, -0.1)) {
  GrainSample made{time, {}, std::move(touches)};
  made.record.set(GrainRecord::position, centre + moved);
  made.record.set(GrainRecord::velocity, Vec3(speed, 0.0, 0.0));
  made.record.set(GrainRecord::fluid_force, force);
  made.record.set(GrainRecord::fluid_couple, couple);
  return made;
}

TEST(Hinge, TorquesAreThoseOfARigidBody) {
  const GrainRing ring{sample(0.0, 0.0, {wall, one, two, three}), sample(0.1, 0.0, {wall, one, two, three}),
                       sample(0.2, 1.0, {one, two}, Vec3(0.1, 0.0, 0.02))};
  EXPECT_EQ(onset_of(ring, 0.01), 1u);
  const auto hinge = hinge_of(ring, 1, Vec3(0.1, 0.0, 0.02));
  ASSERT_TRUE(hinge);
  EXPECT_EQ(hinge->partners, (std::array<GlobalId, 2>{1, 2}));
  EXPECT_NEAR((hinge->axis - Vec3::UnitY()).norm(), 0.0, 1e-15);  // rolling downstream turns about +y
  EXPECT_NEAR((hinge->points[1] - centre - two.arm).norm(), 0.0, 1e-15);
  const HingeTorques torques = torques_about(*hinge, ring[1], Vec3(0.1, 0.0, -3.0), Vec3::Zero());
  EXPECT_NEAR(torques.couple, 0.6, 1e-14);
  EXPECT_NEAR(torques.fluid, h * 2.0 + a * 0.5 + 0.6, 1e-14);  // drag over h, lift over a, and the couple
  EXPECT_NEAR(torques.critical, a * 3.0 - h * 0.1, 1e-14);     // weight over a, less its part along the bed over h
  const HingeTorques afloat = torques_about(*hinge, ring[1], Vec3(0.1, 0.0, -3.0), Vec3(0.0, 0.0, 0.5));
  EXPECT_NEAR(afloat.fluid, h * 2.0 + 0.6, 1e-14);  // the lift was buoyancy
  // The centre has gone 0.1 m along x and 0.02 m up.
  EXPECT_NEAR(torques_about(*hinge, ring[2], Vec3(0.0, 0.0, -3.0), Vec3::Zero()).critical, (a - 0.1) * 3.0, 1e-14);
}

// In a stream to the left the mirror image of the hinge: the contacts furthest along the way of the grain.
TEST(Hinge, IsMirroredWithTheStream) {
  const auto mirrored = [](Touch touch) {
    touch.arm.x() *= -1.0;
    touch.force.x() *= -1.0;
    return touch;
  };
  const std::vector<Touch> touches{mirrored(one), mirrored(two), mirrored(three)};
  const GrainRing ring{sample(0.0, 0.0, touches), sample(0.1, 1.0, touches, Vec3(-0.1, 0.0, 0.02))};
  const auto hinge = hinge_of(ring, 0, Vec3(-0.1, 0.0, 0.02));
  ASSERT_TRUE(hinge);
  EXPECT_EQ(hinge->partners, (std::array<GlobalId, 2>{1, 2}));
  EXPECT_NEAR((hinge->axis + Vec3::UnitY()).norm(), 0.0, 1e-15);
  const HingeTorques torques =
      torques_about(*hinge, sample(0.0, 0.0, touches, Vec3::Zero(), Vec3(-2.0, 0.0, 0.5), Vec3(-0.3, -0.6, 0.1)),
                    Vec3(-0.1, 0.0, -3.0), Vec3::Zero());
  EXPECT_NEAR(torques.fluid, h * 2.0 + a * 0.5 + 0.6, 1e-14);
  EXPECT_NEAR(torques.critical, a * 3.0 - h * 0.1, 1e-14);
}

// A clump that touches one neighbour with two members rolls about the line through both contacts, wherever the members'
// centres are; a contact goes on as that of the same member.
TEST(Hinge, OfAClumpIsThroughTheContactsOfItsMembers) {
  const auto by = [](GlobalId member, const Touch& touch, const Vec3& from_centre) {
    return Touch{1, touch.arm - from_centre, touch.force, touch.distance, member, from_centre};
  };
  const Touch left = by(7, one, Vec3(0.1, 0.3, -0.2)), right = by(8, two, Vec3(0.1, -0.3, -0.2));
  const GrainRing ring{sample(0.0, 0.0, {left, right, three}), sample(0.1, 1.0, {left, right}, Vec3(0.1, 0.0, 0.02))};
  const auto hinge = hinge_of(ring, 0, Vec3(0.1, 0.0, 0.02));
  ASSERT_TRUE(hinge);
  EXPECT_EQ(hinge->partners, (std::array<GlobalId, 2>{1, 1}));
  EXPECT_NEAR((hinge->axis - Vec3::UnitY()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((hinge->points[0] - centre - one.arm).norm(), 0.0, 1e-15);
  const HingeTorques torques = torques_about(*hinge, ring[0], Vec3(0.1, 0.0, -3.0), Vec3::Zero());
  EXPECT_NEAR(torques.fluid, h * 2.0 + a * 0.5 + 0.6, 1e-14);
  EXPECT_NEAR(torques.critical, a * 3.0 - h * 0.1, 1e-14);
  // Where one member leaves, the hinge is that of the other two contacts.
  const GrainRing sideways{sample(0.0, 0.0, {left, right, three}),
                           sample(0.1, 1.0, {left, three}, Vec3(0.0, 0.1, 0.0))};
  EXPECT_EQ(hinge_of(sideways, 0, Vec3(0.0, 0.1, 0.0))->partners, (std::array<GlobalId, 2>{1, 3}));
}

TEST(Hinge, IsWhereTheGrainStaysInTouch) {
  const Touch obstacle{9, {1.0, 0.0, 0.0}, {-5.0, 0.0, 0.0}, 2.0};
  // It leaves grain 2 and rolls sideways over 1 and 3, and then runs into grain 9, which was no contact of its rest.
  const GrainRing sideways{sample(0.0, 0.0, {one, two, three}), sample(0.1, 1.0, {one, three}, Vec3(0.0, 0.05, 0.0)),
                           sample(0.2, 1.0, {one, obstacle}, Vec3(0.0, 0.1, 0.0))};
  const auto hinge = hinge_of(sideways, 0, Vec3(0.0, 0.1, 0.0));
  ASSERT_TRUE(hinge);
  EXPECT_EQ(hinge->partners, (std::array<GlobalId, 2>{1, 3}));
  EXPECT_GT(hinge->axis.cross(centre - hinge->points[0]).y(), 0.0);
  // A contact that pulls is not loaded.
  const Touch pulls{2, two.arm, -two.force, 2.0};
  const GrainRing pulled{sample(0.0, 0.0, {one, pulls, three})};
  EXPECT_EQ(hinge_of(pulled, 0, Vec3::UnitX())->partners, (std::array<GlobalId, 2>{1, 3}));
  // Two contacts are needed, at the onset or before.
  EXPECT_FALSE(hinge_of({sample(0.0, 0.0, {one})}, 0, Vec3::UnitX()));
  const GrainRing before{sample(0.0, 0.0, {one, two}), sample(0.1, 0.0, {}), sample(0.2, 1.0, {})};
  EXPECT_EQ(hinge_of(before, 1, Vec3::UnitX())->partners, (std::array<GlobalId, 2>{1, 2}));
}

TEST(Hinge, TheShareIsThatOfTheSumsUntilTheOnset) {
  const Vec3 weight(0.0, 0.0, -3.0);
  const GrainRing ring{sample(0.0, 0.0, {one, two}, Vec3::Zero(), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.4, 0.0)),
                       sample(0.1, 0.0, {one, two}, Vec3::Zero(), Vec3(3.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)),
                       sample(0.2, 1.0, {one, two}, Vec3(0.1, 0.0, 0.0), Vec3(90.0, 0.0, 0.0), Vec3(0.0, 9.0, 0.0))};
  const EntrainedGrain grain{7, 1.0, centre, weight, Vec3::Zero()};
  const Entraining found = entraining_of(grain, ring, 0.01);
  EXPECT_EQ(found.onset, 1u);
  EXPECT_NEAR(found.couple_share(), 0.4 / (h * 1.0 + 0.4 + h * 3.0), 1e-14);
  EXPECT_NEAR(found.largest_torque_ratio(), h * 3.0 / (a * 3.0), 1e-14);
  const Event event = event_of("event_000001", grain, ring, found);
  EXPECT_EQ(event.time, 0.2);
  for (const Profile& array : event.arrays) {
    std::uint64_t size = 1;
    for (const auto n : array.shape) size *= n;
    EXPECT_EQ(array.values.size(), size) << array.name;
    if (array.name == "contact_partner_position") {
      EXPECT_NEAR(array.values[0], centre.x() + 2.0 * a / one.arm.norm(), 1e-14);
      EXPECT_EQ(array.shape[0], 6u);
    }
  }
  // A fluid that holds the grain back has no share in its start.
  GrainRing held;
  for (GrainSample s : ring) {
    s.record.set(GrainRecord::fluid_force, Vec3(-5.0, 0.0, 0.0));
    held.push_back(s);
  }
  EXPECT_TRUE(std::isnan(entraining_of(grain, held, 0.01).couple_share()));
}

}  // namespace
}  // namespace thalweg::analysis::hinge_test
