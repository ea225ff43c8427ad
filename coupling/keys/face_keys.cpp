#include "coupling/keys/face_keys.hpp"

#include "core/geometry/layer_at.hpp"

namespace thalweg::coupling {

using lbm::FaceType;

namespace {

const std::vector<NamedChoice<FaceType>> face_types{
    {FaceType::periodic, "periodic"},
    {FaceType::no_slip, "no_slip"},
    {FaceType::free_slip, "free_slip"},
    {FaceType::moving, "moving", "no slip on a moving wall; with a fluid it moves in its own plane"},
    {FaceType::navier_slip, "navier_slip", "slip velocity = slip length x shear rate"},
    {FaceType::law_of_the_wall, "law_of_the_wall", "imposes the stress of the boundary layer on a smooth wall"},
    {FaceType::slip_law_of_the_wall, "slip_law_of_the_wall",
     "slip velocity = coefficient x friction velocity, as published"},
    {FaceType::velocity_inlet, "velocity_inlet"},
    {FaceType::pressure_outlet, "pressure_outlet"}};

bool same_law(const FaceKeys& a, const FaceKeys& b) {
  return a.of_first_cell == b.of_first_cell && (a.of_first_cell || a.coefficient == b.coefficient);
}

lbm::FaceCondition condition_of(const FaceKeys& face, const Units& units) {
  lbm::FaceCondition condition;
  condition.type = face.type;
  condition.slip_coefficient = face.coefficient;
  condition.slip_of_first_cell = face.type == FaceType::slip_law_of_the_wall && face.of_first_cell;
  condition.slip_length = face.slip_length / units.spacing;
  condition.velocity = face.velocity / units.velocity();
  if (face.recycling_plane) condition.recycling_plane = layer_at(*face.recycling_plane, units.spacing);
  condition.density_deviation = 3.0 * face.pressure / units.stress();  // p = rho/3 in lattice units
  return condition;
}

}  // namespace

bool FaceKeys::operator==(const FaceKeys& other) const {
  return type == other.type && (type != FaceType::slip_law_of_the_wall || same_law(*this, other)) &&
         (type != FaceType::navier_slip || slip_length == other.slip_length) &&
         (!has_velocity() || velocity == other.velocity) &&
         (type != FaceType::velocity_inlet || recycling_plane == other.recycling_plane) &&
         (type != FaceType::moving || oscillation == other.oscillation) &&
         (type != FaceType::pressure_outlet || pressure == other.pressure);
}

void describe(SectionVisitor& visit, FaceKeys& face) {
  visit.choice(
      "type", face.type, face_types,
      {.meaning = "kind of face",
       .required = true,
       .removed = {
           {"law_of_the_wall_as_printed",
            "the law with the printed coefficient is {type: slip_law_of_the_wall, coefficient: 2.35}; write that"}}});
  visit.not_here("on_node", "faces lie half a cell beyond the last cell centres; remove the key");
  const bool law = face.type == FaceType::slip_law_of_the_wall;
  const std::string of_the_law =
      face.type == FaceType::law_of_the_wall
          ? "a law_of_the_wall imposes the stress of the law and has no coefficient; remove the key, or write type: "
            "slip_law_of_the_wall, which is the slip as published"
          : "only a slip_law_of_the_wall has a coefficient; remove it";
  const std::string with_the_law = "type: slip_law_of_the_wall";
  visit.flag("of_first_cell", face.of_first_cell,
             {.meaning = "take the coefficient from the law of the wall at the first cell's centre, whose distance in "
                         "wall units grows with the stress",
              .only_if = {law, of_the_law, with_the_law}});
  visit.real(
      "coefficient", face.coefficient,
      {.meaning = "slip velocity at the wall over the friction velocity",
       .above = 0.0,
       .only_if = {law && !face.of_first_cell,
                   law ? "of_first_cell finds the coefficient; remove one of the two" : of_the_law, with_the_law}});
  visit.real("slip_length", face.slip_length,
             {.unit = "m",
              .meaning = "distance behind the wall at which the extrapolated velocity is zero",
              .required = true,
              .at_least = 0.0,
              .example = 1e-4,
              .only_if = {face.type == FaceType::navier_slip, "only a navier_slip wall has a slip length; remove it",
                          "type: navier_slip"}});
  visit.vec3("velocity", face.velocity,
             {.unit = "m/s",
              .meaning = "of the wall or of the incoming fluid; with recycling_plane its mean over the whole face",
              .required = true,
              .example = 0.1,
              .only_if = {face.has_velocity(), "only a moving wall or a velocity_inlet has a velocity; remove it",
                          "type: moving or velocity_inlet"}});
  visit.real("recycling_plane", face.recycling_plane,
             {.unit = "m",
              .meaning = "position along the face normal of the plane whose flow enters again, with its profile and "
                         "turbulence, at a mean of `velocity`; default: uniform inflow at `velocity`",
              .above = 0.0,
              .example = 0.08,
              .only_if = {face.type == FaceType::velocity_inlet,
                          "only a velocity_inlet recycles the flow of a plane; remove it", "type: velocity_inlet"}});
  visit.section("oscillation", face.oscillation,
                {.meaning = "dry grains only: added to the velocity",
                 .only_if = {face.type == FaceType::moving, "only a moving wall swings; remove it", "type: moving"}});
  visit.real("pressure", face.pressure,
             {.unit = "Pa",
              .meaning = "above the reference pressure",
              .only_if = {face.type == FaceType::pressure_outlet, "only a pressure_outlet has a pressure; remove it",
                          "type: pressure_outlet"}});
}

lbm::FaceConditions conditions_of(const std::array<FaceKeys, 6>& faces, const Units& units) {
  lbm::FaceConditions conditions;
  for (std::size_t face = 0; face < faces.size(); ++face) conditions[face] = condition_of(faces[face], units);
  return conditions;
}

}  // namespace thalweg::coupling
