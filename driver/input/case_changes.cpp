#include "driver/input/case_changes.hpp"

#include "core/base/error.hpp"
#include "core/base/round_off.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

namespace thalweg::driver {

namespace {

using Values = std::vector<std::pair<std::string, std::string>>;  // by key

bool is_of_scalars(const YAML::Node& list) {
  return std::all_of(list.begin(), list.end(), [](const YAML::Node& item) { return item.IsScalar(); });
}

// Grains know their material by its number, which counts the populations that have a section of their own.
bool is_material(std::string_view key) { return key.starts_with("grains.") && key.ends_with(".contact"); }

void add_values(const YAML::Node& node, const std::string& key, Values& values) {
  const auto below = [&key](const std::string& name) { return key.empty() ? name : key + "." + name; };
  if (node.IsMap()) {
    if (is_material(key)) values.emplace_back(key, "a section");
    for (const auto& entry : node) add_values(entry.second, below(entry.first.as<std::string>()), values);
  } else if (node.IsSequence() && !is_of_scalars(node)) {
    for (std::size_t n = 0; n < node.size(); ++n) add_values(node[n], below(std::to_string(n)), values);
  } else if (node.IsSequence()) {
    values.emplace_back(key, fmt::format("[{}]", fmt::join(node.as<std::vector<std::string>>(), ", ")));
  } else {
    values.emplace_back(key, node.IsNull() ? "none" : node.as<std::string>());
  }
}

// e.g. "grains.0.density: 2550"; no key contains the separator.
constexpr std::string_view separator = ": ";

Values values_of(const std::string& yaml) {
  Values values;
  try {
    add_values(YAML::Load(yaml), "", values);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format(
        "The case.yaml kept in the run folder cannot be read ({}): restore it, or begin a new run.", error.what()));
  }
  std::erase_if(values, [](const auto& value) {
    return value.first.starts_with("initial.") || value.first.find(".placement") != std::string::npos;
  });
  return values;
}

// The first item, taken off the list without its brackets.
std::string_view take_item(std::string_view& list) {
  constexpr std::string_view comma = ", ";
  const std::size_t end = list.find(comma);
  const std::string_view item = list.substr(0, end);
  list.remove_prefix(end == std::string_view::npos ? list.size() : end + comma.size());
  return item;
}

std::string find(const Values& values, const std::string& key) {
  const auto found =
      std::find_if(values.begin(), values.end(), [&key](const auto& value) { return value.first == key; });
  return found == values.end() ? "none" : found->second;
}

bool is_list(const std::string& text) { return text.starts_with('[') && text.ends_with(']'); }

// Lists are as add_values() writes them.
bool same(const std::string& one, const std::string& other) {
  if (one == other) return true;
  if (is_list(one) && is_list(other)) {
    const auto rest_of = [](std::string_view list) { return list.substr(1, list.size() - 2); };
    std::string_view left = rest_of(one), right = rest_of(other);
    while (!left.empty() && !right.empty()) {
      if (!same(std::string(take_item(left)), std::string(take_item(right)))) return false;
    }
    return left.empty() && right.empty();
  }
  char *end_of_one = nullptr, *end_of_other = nullptr;
  const double a = std::strtod(one.c_str(), &end_of_one), b = std::strtod(other.c_str(), &end_of_other);
  return *end_of_one == '\0' && *end_of_other == '\0' && !one.empty() && !other.empty() && same_but_for_rounding(a, b);
}

// In full gravity the pressure of the fluid is hydrostatic. Earlier checkpoints do not say whether it was.
bool is_said_lately(std::string_view key) { return key == "gravity.mode"; }

bool is_in_the_checkpoint(std::string_view key) {
  constexpr std::array<std::string_view, 7> state{"system",          "domain.size", "domain.spacing", "disks",
                                                  "fluid.precision", "supplies",    "sinks"};
  const auto is_or_is_below = [key](std::string_view section) {
    return key.starts_with(section) && (key.size() == section.size() || key[section.size()] == '.');
  };
  if (std::any_of(state.begin(), state.end(), is_or_is_below) || is_said_lately(key)) return true;
  return is_or_is_below("grains") && (key.find(".contact") == std::string_view::npos || is_material(key));
}

// True for keys of the motion of a wall or solid: its position follows from the motion since the start of the run, so
// another motion would displace it at once. Walls of a fluid move in their own plane.
bool places_a_wall(std::string_view key, bool dry) {
  if (key.starts_with("solids.") && key.find(".motion") != std::string_view::npos) return true;
  const bool of_motion =
      key.find(".velocity") != std::string_view::npos || key.find(".oscillation") != std::string_view::npos;
  return of_motion && (key.starts_with("walls.") || (dry && key.starts_with("domain.boundaries.")));
}

Values state_values(const std::string& yaml, bool dry) {
  Values values = values_of(yaml);
  std::erase_if(values, [dry](const auto& value) {
    return !is_in_the_checkpoint(value.first) && !places_a_wall(value.first, dry);
  });
  return values;
}

std::vector<CaseChange> changes_of(const Values& before, const Values& now) {
  std::vector<CaseChange> changes;
  for (const auto& [key, value] : before)
    if (const std::string other = find(now, key); !same(value, other)) changes.push_back({key, value, other});
  for (const auto& [key, value] : now)
    if (find(before, key) == "none" && value != "none") changes.push_back({key, "none", value});
  return changes;
}

// e.g. "grains.0.density = 2650: the run to be continued has 2550"
std::string told(const CaseChange& change) {
  return fmt::format("{} = {}: the run to be continued {}", change.key, change.now,
                     change.before == "none" ? "does not have this key" : "has " + change.before);
}

}  // namespace

std::vector<CaseChange> case_changes(const std::string& before, const std::string& now) {
  return changes_of(values_of(before), values_of(now));
}

std::string state_of_case(const std::string& yaml, bool dry) {
  std::string text;
  for (const auto& [key, value] : state_values(yaml, dry)) text += fmt::format("{}{}{}\n", key, separator, value);
  return text;
}

std::vector<CaseChange> state_changes(const std::string& before, const std::string& now, bool dry) {
  Values values;
  std::istringstream lines(before);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(separator);
    if (end != std::string::npos) values.emplace_back(line.substr(0, end), line.substr(end + separator.size()));
  }
  Values values_now = state_values(now, dry);
  std::erase_if(values_now,
                [&](const auto& value) { return is_said_lately(value.first) && find(values, value.first) == "none"; });
  return changes_of(values, values_now);
}

void refuse_changes_of_state(const std::vector<CaseChange>& changes, bool dry) {
  for (const CaseChange& change : changes) {
    if (places_a_wall(change.key, dry))
      throw InputError(
          told(change) +
          ". A wall or a solid is where its motion has brought it since the start, and would jump; set the key back, "
          "or begin a new run from that one with initial.from, with the wall or the solid where it is now.");
    if (is_in_the_checkpoint(change.key))
      throw InputError(
          told(change) +
          ". Grains and lattice are in its checkpoint; set the key back, or begin a new run from that one with "
          "initial.from.");
  }
}

}  // namespace thalweg::driver
