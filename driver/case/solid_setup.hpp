// The solids of a case, from their files to what coupling wants.
#pragma once

#include "bodies/map/solid_shape.hpp"
#include "core/geometry/triangle_mesh.hpp"
#include "core/parallel/ranks.hpp"
#include "dem/motion/prescribed_motion.hpp"
#include "driver/case/case.hpp"
#include "io/text/yaml_document.hpp"

#include <set>
#include <string>
#include <vector>

namespace thalweg::driver {

// Reads the surfaces of the solids that have an STL file. Throws InputError with the place in the case, and that in the
// file, where one cannot be read or is not closed. Collective.
void fill_in_surfaces(Case& c, const io::YamlDocument& document, const Ranks& ranks);

// The lowest and the highest coordinates of a solid whose surface has been read, m.
bodies::Extent extent_of(const SolidCase& solid);

// Throws InputError where a solid lies so far from the box, or is so much longer than a periodic box, that it cannot be
// meant.
void check_solid_extents(const Case& c, const io::YamlDocument& document);

// The key that gives a solid its size, and what to do where it is too large.
std::string shape_key(const Case& c, std::size_t solid);
std::string smaller_text(const SolidCase& solid);

// Shapes in lattice units, at the start, in the order of the case.
std::vector<bodies::SolidShape> solid_shapes(const Case& c);

// Motion of a solid; it stands still where the case gives none.
dem::PrescribedMotion motion_of(const SolidCase& solid);

bool any_solid_moves(const Case& c);

// The times between frames of grains and of the fluid, s, each of which has a frame of the solids that move; empty:
// there are none. Solids that all stand still have one frame.
std::set<double> solid_frames_every(const Case& c);

// The surfaces of all solids at a time (s), in m; spheres as triangles. One that moves is in the box, in parts where it
// crosses a periodic face.
std::vector<TriangleMesh> solid_surfaces(const Case& c, double time);

// Largest distance of a rotating solid from its axis, m.
double reach_from_axis(const SolidCase& solid);

// Upper bound of the speed of any point of a solid, m/s.
double largest_speed(const SolidCase& solid);

}  // namespace thalweg::driver
