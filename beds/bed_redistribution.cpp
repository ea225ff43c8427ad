#include "beds/bed_redistribution.hpp"

#include "beds/population/population_clumps.hpp"

#include <algorithm>
#include <memory>

namespace thalweg::beds {
namespace {

// A row in a message. position: of the centre of its grain or clump, m, wrapped, which decides where it is sent.
struct FileRow {
  double position[3];
  GlobalId id, clump;
  double radius, density;
  double at[3], velocity[3], angular_velocity[3];
  double body[11];  // volume, from_first, moments, orientation; volume 0: none
};

FileRow packed(const BedGrain& row, const Vec3& centre) {
  FileRow packed{{}, row.id, row.clump, row.radius, row.density, {}, {}, {}, {}};
  std::copy_n(centre.data(), 3, packed.position);
  std::copy_n(row.position.data(), 3, packed.at);
  std::copy_n(row.velocity.data(), 3, packed.velocity);
  std::copy_n(row.angular_velocity.data(), 3, packed.angular_velocity);
  if (row.body) {
    packed.body[0] = row.body->volume;
    std::copy_n(row.body->from_first.data(), 3, packed.body + 1);
    std::copy_n(row.body->moments.data(), 3, packed.body + 4);
    std::copy_n(row.body->orientation.data(), 4, packed.body + 7);
  }
  return packed;
}

BedGrain unpacked(const FileRow& row) {
  BedGrain grain{row.id,    row.radius, row.density, Vec3(row.at), Vec3(row.velocity), Vec3(row.angular_velocity),
                 row.clump, {}};
  if (const double* b = row.body; b[0] > 0.0)
    grain.body = std::make_shared<const BedBody>(BedBody{b[0], Vec3(b + 1), Vec3(b + 4), {b[7], b[8], b[9], b[10]}});
  return grain;
}

struct SphereRow {
  double position[3], radius;
  GlobalId id;
};

}  // namespace

std::vector<BedGrain> rows_known(const Population& population, const PackingDomain& ranks, const CentreOf& centre_of) {
  std::vector<FileRow> sent;
  sent.reserve(population.file.size());
  for (const std::span<const BedGrain> body : bodies_of(population.file)) {
    const Vec3 centre = ranks.box().wrapped(centre_of(body));
    for (const BedGrain& row : body) sent.push_back(packed(row, centre));
  }
  std::vector<BedGrain> rows;
  for (const FileRow& row : population.motion ? ranks.gathered(sent) : ranks.to_knowing(sent))
    rows.push_back(unpacked(row));
  return rows;
}

std::vector<Obstacle> spheres_of_file(const Population& population, const PackingDomain& ranks) {
  std::vector<SphereRow> mine;
  for (const BedGrain& row : population.file) {
    const Vec3 at = ranks.box().wrapped(row.position);
    mine.push_back({{at[0], at[1], at[2]}, row.radius, row.id});
  }
  std::vector<Obstacle> spheres;
  for (const SphereRow& row : ranks.to_knowing(mine)) spheres.push_back({{Vec3(row.position), row.radius}, row.id});
  return spheres;
}

}  // namespace thalweg::beds
