#include "io/output_keys.hpp"

// Static rather than in an unnamed namespace, where argument-dependent lookup would not find them.
namespace thalweg::io {

static void describe(SectionVisitor& visit, SeriesOutputKeys& series) {
  visit.real("every", series.every, {.unit = "s", .meaning = "between rows of series.csv; 0: none", .at_least = 0.0});
}

static void describe(SectionVisitor& visit, FluidOutputKeys& fluid) {
  visit.real("every", fluid.every, {.unit = "s", .meaning = "between frames of the fluid; 0: none", .at_least = 0.0});
  visit.choice<FluidRegion>("region", fluid.region,
                            {{FluidRegion::whole, "whole"},
                             {FluidRegion::slice_x, "slice_x"},
                             {FluidRegion::slice_y, "slice_y"},
                             {FluidRegion::slice_z, "slice_z"}},
                            {.meaning = "the whole box, or the middle layer of cells across an axis"});
  visit.choice_list<FluidField>("fields", fluid.fields,
                                {{FluidField::velocity, "velocity", "m/s"},
                                 {FluidField::pressure, "pressure", "Pa above the reference"},
                                 {FluidField::grain_id, "grain_id", "-1 in the fluid"},
                                 {FluidField::density, "density", "kg/m^3"},
                                 {FluidField::shear_rate, "shear_rate", "1/s, of the subgrid model"},
                                 {FluidField::eddy_viscosity, "eddy_viscosity", "m^2/s, of the subgrid model"},
                                 {FluidField::vorticity, "vorticity", "1/s"},
                                 {FluidField::q_criterion, "q_criterion", "1/s^2, vortices where positive"}},
                                {.meaning = "what the frames contain"});
}

static void describe(SectionVisitor& visit, GrainOutputKeys& grains) {
  visit.real("every", grains.every, {.unit = "s", .meaning = "between frames of the grains; 0: none", .at_least = 0.0});
}

static void describe(SectionVisitor& visit, CheckpointOutputKeys& checkpoint) {
  visit.real("every", checkpoint.every,
             {.unit = "s", .meaning = "between checkpoints; 0: only by wall time", .at_least = 0.0});
  visit.real("every_wall", checkpoint.every_wall,
             {.unit = "s of wall time",
              .meaning = "since the last checkpoint, after which another one is written; 0: only by simulated time",
              .at_least = 0.0});
  visit.integer("keep", checkpoint.keep, {.meaning = "number of newest checkpoints that are kept", .at_least = 1});
}

void describe(SectionVisitor& visit, OutputKeys& output, const OnlyIf& of_fluid, const OnlyIf& of_grains) {
  visit.section("series", output.series, {.meaning = "the table series.csv"});
  visit.section("fluid", output.fluid, {.meaning = "VTK output of the fluid, fluid.pvd", .only_if = of_fluid});
  visit.section("grains", output.grains, {.meaning = "VTK output of the grains, grains.pvd", .only_if = of_grains});
  visit.section("checkpoint", output.checkpoint, {.meaning = "states from which the run can be continued"});
}

}  // namespace thalweg::io
