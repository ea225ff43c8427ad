#include "io/fluid_series.hpp"

#include "core/on_first_rank.hpp"
#include "io/atomic_file.hpp"
#include "io/region_order.hpp"
#include "io/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace thalweg::io {
namespace {

const char* name_of(FluidField field) {
  switch (field) {
    case FluidField::velocity:
      return "velocity";
    case FluidField::pressure:
      return "pressure";
    case FluidField::grain_id:
      return "grain_id";
    case FluidField::density:
      return "density";
    case FluidField::shear_rate:
      return "shear_rate";
    case FluidField::eddy_viscosity:
      return "eddy_viscosity";
    case FluidField::vorticity:
      return "vorticity";
    case FluidField::q_criterion:
      return "q_criterion";
  }
  throw std::logic_error("unknown fluid field");
}

// The cells of the region, in global coordinates.
Block block_of(FluidRegion region, const Index3& cells) {
  Block block{{0, 0, 0}, cells};
  if (region == FluidRegion::whole) return block;
  const int axis = region == FluidRegion::slice_x ? 0 : region == FluidRegion::slice_y ? 1 : 2;
  block.lower[axis] = cells[axis] / 2;
  block.upper[axis] = block.lower[axis] + 1;
  return block;
}

std::string extent_text(const Block& block) {
  return fmt::format("{} {} {} {} {} {}", block.lower[0], block.upper[0], block.lower[1], block.upper[1],
                     block.lower[2], block.upper[2]);
}

}  // namespace

FluidSeries::FluidSeries(MPI_Comm communicator, const std::filesystem::path& run_folder, FluidRegion region,
                         std::vector<FluidField> fields, std::optional<double> continue_from)
    : communicator_(communicator),
      folder_(run_folder),
      region_(region),
      fields_(std::move(fields)),
      index_(run_folder / "fluid.pvd", continue_from) {}

void FluidSeries::write(const Snapshot& snapshot) {
  if (!snapshot.fluid) return;
  const Decomposition& decomposition = *snapshot.decomposition;
  const Block region = block_of(region_, decomposition.cells());
  const FluidFields fields = snapshot.fluid->sample(fields_, region);
  VtkXmlFile picture(communicator_, region.volume());
  const RegionOrder order(communicator_, decomposition, region, picture.share());
  for (const FluidField field : fields_) {
    const int components = components_of(field);
    if (field == FluidField::grain_id)
      picture.add("CellData", name_of(field), components, order.share_of(fields.grain_id, components));
    else
      picture.add("CellData", name_of(field), components, order.share_of(values_of(fields, field), components));
  }

  const auto file = std::filesystem::path("fluid") / fmt::format("fluid_{:09d}.vti", snapshot.step);
  const std::string extent = extent_text(region);
  on_first_rank(communicator_, [&] { make_folder(folder_ / "fluid"); });
  picture.write(
      folder_ / file, "ImageData",
      fmt::format(" WholeExtent=\"{0}\" Origin=\"0 0 0\" Spacing=\"{1} {1} {1}\"", extent, decomposition.spacing()),
      fmt::format(" Extent=\"{}\"", extent));
  on_first_rank(communicator_, [&] { index_.add(snapshot.time, file); });
}

}  // namespace thalweg::io
