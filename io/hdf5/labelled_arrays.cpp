#include "io/hdf5/labelled_arrays.hpp"

#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace thalweg::io {
namespace {

// Name of a dimension of components.
std::string axis_of(const std::string& array, const std::vector<std::string>& components) {
  if (components.size() == 3 && components[0] == "x") return "axis";
  if (components.size() == 6 && components[0] == "xx") return "symmetric";
  if (components.size() == 9 && components[0] == "xx") return "tensor";
  return array + "_component";
}

std::string path_of(const std::string& group, const std::string& name) {
  return group.empty() ? name : group + "/" + name;
}

}  // namespace

void ArrayLabeller::write(const std::string& group, const Profile& array) {
  write_whole(file_, file_.communicator(), path_of(group, array.name), std::span<const double>(array.values),
              array.shape);
  label(group, array.name, array.shape, {array.unit, array.axes, array.components});
}

void ArrayLabeller::write(const std::string& group, const WholeNumbers& numbers) {
  write_whole(file_, file_.communicator(), path_of(group, numbers.name), numbers.values);
  label(group, numbers.name, {numbers.values.size()}, {"1", {numbers.axis}, {}});
}

void ArrayLabeller::label(const std::string& group, const std::string& name, const std::vector<std::uint64_t>& shape,
                          const ArrayLabels& labels) {
  const std::string path = path_of(group, name);
  file_.attribute(path + "/units", labels.unit);
  if (!labels.components.empty())
    file_.attribute(path + "/components", fmt::format("{}", fmt::join(labels.components, " ")));
  Array array{group, name, shape, labels.axes};
  if (!labels.components.empty()) array.axes.push_back(axis_of(name, labels.components));
  if (array.axes.size() != shape.size())
    throw std::logic_error(fmt::format("array {}: {} dimensions and {} names", path, shape.size(), array.axes.size()));
  arrays_.push_back(std::move(array));
}

void ArrayLabeller::name_dimensions() {
  std::set<std::string> coordinates;
  for (const Array& array : arrays_)
    if (array.shape.size() == 1 && array.axes[0] == array.name) coordinates.insert(path_of(array.group, array.name));
  std::map<std::string, std::uint64_t> lengths;  // by path
  DimensionScales scales;
  for (const Array& array : arrays_) {
    const std::string path = path_of(array.group, array.name);
    std::vector<std::string> of_array;
    for (std::size_t d = 0; d < array.shape.size(); ++d) {
      of_array.push_back(path_of(array.group, array.axes[d]));
      if (lengths.try_emplace(of_array.back(), array.shape[d]).first->second != array.shape[d])
        throw std::logic_error(fmt::format("array {}: {} has another length than elsewhere", path, array.axes[d]));
    }
    if (coordinates.count(path) == 0) scales.of_arrays.emplace_back(path, std::move(of_array));
  }
  for (const auto& [path, length] : lengths) {
    const bool is_coordinate = coordinates.count(path) > 0;
    scales.scales.push_back({path, length, is_coordinate});
    if (is_coordinate) continue;
    std::vector<std::int64_t> numbers(length);
    std::iota(numbers.begin(), numbers.end(), 0);
    write_whole(file_, file_.communicator(), path, numbers);
  }
  file_.name_dimensions(scales);
}

}  // namespace thalweg::io
