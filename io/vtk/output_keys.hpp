// Keys of output files: the section `output`.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "io/vtk/fluid_series.hpp"
#include "io/vtk/grain_fields.hpp"
#include "io/vtk/grain_selection.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg::io {

// every: s of simulated time; 0: never (checkpoint: only at the end of the run, and by every_wall).
struct SeriesOutputKeys {
  double every = 0.01;
  bool operator==(const SeriesOutputKeys&) const = default;
};
struct FluidOutputKeys : FluidRegionKeys {
  double every = 0.0;
  std::vector<FluidField> fields{FluidField::velocity, FluidField::pressure, FluidField::grain_id};
  FieldPrecision precision = FieldPrecision::single;
  bool operator==(const FluidOutputKeys&) const = default;
};
// One more series of frames of the fluid.
struct NamedFluidOutputKeys : FluidOutputKeys {
  std::string name;
  bool operator==(const NamedFluidOutputKeys&) const = default;
};
struct GrainOutputKeys {
  double every = 0.0;
  std::vector<GrainField> fields;  // empty: all that the case has
  bool operator==(const GrainOutputKeys&) const = default;
};
// One more series of frames of the grains.
struct NamedGrainOutputKeys : GrainOutputKeys, GrainSelectionKeys {
  std::string name;
  bool operator==(const NamedGrainOutputKeys&) const = default;
};
struct CheckpointOutputKeys {
  double every = 0.0;
  double every_wall = 1800.0;  // s of wall time; 0: never
  std::int64_t keep = 2;       // newest checkpoints that stay on the disk
  bool operator==(const CheckpointOutputKeys&) const = default;
};

struct OutputKeys {
  SeriesOutputKeys series;
  FluidOutputKeys fluid;
  std::vector<NamedFluidOutputKeys> fluid_parts;
  GrainOutputKeys grains;
  std::vector<NamedGrainOutputKeys> grain_parts;
  CheckpointOutputKeys checkpoint;
  bool operator==(const OutputKeys&) const = default;
};

// of_fluid, of_grains: the case has a fluid, or grains, whose output can be asked for.
void describe(SectionVisitor& visit, OutputKeys& output, const OnlyIf& of_fluid, const OnlyIf& of_grains);

// Checks that every series of the fluid shows cells of a box of this size (m). Throws KeyError, from the section
// `output` on.
void check_fluid_output(const OutputKeys& output, const Vec3& box_size, double spacing);

// Properties of the grains of a case that output can show and select.
struct GrainOutputFacts : GrainFieldFacts {
  PopulationIds population_ids;
  Vec3 box_size = Vec3::Zero();  // m
};

// Checks that every series of the grains can show the fields it asks for. Throws KeyError, from the section `output`
// on.
void check_grain_output(const OutputKeys& output, const GrainOutputFacts& facts);

}  // namespace thalweg::io
