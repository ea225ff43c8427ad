// `thalweg clump`: spheres that stand for the surface in an STL file, with the figures of both.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

struct ClumpOrder {
  std::string surface;              // STL file
  std::optional<int> spheres;       // as in beds/shapes/mesh_clump.hpp
  std::optional<double> tolerance;  // equivalent diameters
  double scale = 1.0;               // m per unit of the file
  double density = 2650.0;          // kg/m^3, for the figures
  std::string out;                  // file to write without its ending; empty: the surface's name and _clump, here
};

// Makes the clump, writes its spheres as OUT.yaml, and describes all in lines. Throws InputError where no clump can be
// made of the surface.
std::vector<std::string> clump_report(const ClumpOrder& order);

// Becomes the Python program that draws surface and spheres side by side in OUT.png. Throws InputError if that cannot
// be started.
void draw_clump(const ClumpOrder& order);

}  // namespace thalweg::driver
