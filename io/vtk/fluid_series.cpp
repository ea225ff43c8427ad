#include "io/vtk/fluid_series.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"
#include "io/vtk/region_order.hpp"
#include "io/vtk/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

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

// Values of the shown cells among those of the cells of a region in a block, x fastest.
template <typename Number>
std::vector<Number> shown(const std::vector<Number>& values, int components, const ShownCells& cells,
                          const Block& block) {
  if (cells.stride == Index3{1, 1, 1}) return values;
  const Block fine = intersection(block, cells.region), part = cells.part_in(block);
  std::vector<Number> chosen;
  chosen.reserve(static_cast<std::size_t>(part.volume() * components));
  const auto fine_place = [&](int axis, int coarse) {
    return cells.region.lower[axis] + (coarse - cells.coarse.lower[axis]) * cells.stride[axis];
  };
  for (int k = part.lower[2]; k < part.upper[2]; ++k)
    for (int j = part.lower[1]; j < part.upper[1]; ++j)
      for (int i = part.lower[0]; i < part.upper[0]; ++i) {
        const auto first =
            values.begin() + fine.location_of({fine_place(0, i), fine_place(1, j), fine_place(2, k)}) * components;
        chosen.insert(chosen.end(), first, first + components);
      }
  return chosen;
}

std::vector<float> in_single_precision(const std::vector<double>& values) {
  std::vector<float> rounded(values.size());
  std::transform(values.begin(), values.end(), rounded.begin(), [](double value) { return static_cast<float>(value); });
  return rounded;
}

std::string extent_text(const Block& block) {
  return fmt::format("{} {} {} {} {} {}", block.lower[0], block.upper[0], block.lower[1], block.upper[1],
                     block.lower[2], block.upper[2]);
}

}  // namespace

FluidSeries::FluidSeries(MPI_Comm communicator, const std::filesystem::path& folder, std::string name,
                         FluidRegionKeys region, std::vector<FluidField> fields, FieldPrecision precision,
                         std::optional<double> continue_from)
    : communicator_(communicator),
      folder_(folder),
      name_(std::move(name)),
      region_(std::move(region)),
      fields_(std::move(fields)),
      precision_(precision),
      index_(communicator, folder / (name_ + ".pvd"), continue_from) {}

void FluidSeries::write(const Snapshot& snapshot) {
  if (!snapshot.fluid) return;
  const Decomposition& decomposition = *snapshot.decomposition;
  const ShownCells cells = shown_cells(region_, decomposition.cells(), decomposition.spacing());
  const FluidFields fields = snapshot.fluid->sample(fields_, cells.region);
  VtkXmlFile picture(communicator_, cells.coarse.volume());
  std::vector<Block> parts;
  for (int rank = 0; rank < size_of(communicator_); ++rank)
    parts.push_back(cells.part_in(decomposition.block_of(rank)));
  const RegionOrder order(communicator_, parts, cells.coarse, picture.share());
  const Block block = decomposition.block_of(rank_of(communicator_));
  for (const FluidField field : fields_) {
    const int components = components_of(field);
    const auto add = [&](const auto& values) {
      picture.add("CellData", name_of(field), components, order.share_of(values, components));
    };
    if (field == FluidField::grain_id)
      add(shown(fields.grain_id, components, cells, block));
    else if (precision_ == FieldPrecision::double_)
      add(shown(values_of(fields, field), components, cells, block));
    else
      add(in_single_precision(shown(values_of(fields, field), components, cells, block)));
  }

  const auto file = std::filesystem::path(name_) / fmt::format("{}_{:09d}.vti", name_, snapshot.step);
  const std::string extent = extent_text(cells.coarse);
  const Vec3 &origin = cells.origin, &spacing = cells.coarse_spacing;
  on_first_rank(communicator_, [&] { make_folder(folder_ / name_); });
  picture.write(folder_ / file, snapshot.time, "ImageData",
                fmt::format(" WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\"", extent, origin[0],
                            origin[1], origin[2], spacing[0], spacing[1], spacing[2]),
                fmt::format(" Extent=\"{}\"", extent));
  index_.add(snapshot.time, file);
}

}  // namespace thalweg::io
