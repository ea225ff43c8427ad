#include "driver/case/preset.hpp"

#include <preset_texts.hpp>  // driver/CMakeLists.txt writes it

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace thalweg::driver {

namespace {

// Keys that replace one of the preset; a face only as a whole.
struct Alternatives {
  const char* key;
  std::vector<const char*> others;
};

const std::vector<Alternatives>& alternatives() {
  static const std::vector<Alternatives> all{
      {"domain.boundaries.x", {"domain.boundaries.x", "domain.boundaries.x_low", "domain.boundaries.x_high"}},
      {"domain.boundaries.y", {"domain.boundaries.y", "domain.boundaries.y_low", "domain.boundaries.y_high"}},
      {"domain.boundaries.bottom", {"domain.boundaries.bottom"}},
      {"domain.boundaries.top", {"domain.boundaries.top"}},
      {"fluid.smagorinsky_constant", {"fluid.subgrid_model"}},
      {"contact.normal_stiffness", {"contact.duration", "contact.youngs_modulus"}},
      {"contact.tangential_stiffness", {"contact.normal_stiffness", "contact.duration", "contact.youngs_modulus"}},
      {"contact.damping", {"contact.restitution"}},
  };
  return all;
}

std::vector<std::string> keys_with_alternatives_in(const io::YamlDocument& document) {
  std::vector<std::string> keys;
  for (const Alternatives& one : alternatives())
    if (std::any_of(one.others.begin(), one.others.end(), [&](const char* key) { return document.find(key); }))
      keys.emplace_back(one.key);
  return keys;
}

void refuse_other_system(const io::YamlDocument& document, const io::YamlNode& preset) {
  const io::YamlNode *own = document.find("system"), *meant = preset.find("system");
  if (own && meant && own->text != meant->text)
    throw document.error("preset", fmt::format("it is for system: {}, and this case has system: {}; remove the key",
                                               meant->text, own->text));
}

}  // namespace

std::optional<std::string_view> preset_text(const std::string& name) {
  const auto* const found =
      std::find_if(std::begin(presets), std::end(presets), [&](const NamedPreset& one) { return one.name == name; });
  if (found == std::end(presets)) return std::nullopt;
  return found->text;
}

std::string preset_names() {
  std::vector<std::string_view> names;
  for (const NamedPreset& one : presets) names.push_back(one.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string lay_preset_beneath(io::YamlDocument& document) {
  const io::YamlNode* named = document.find("preset");
  if (!named) return {};
  const std::string name = named->text;
  const std::optional<std::string_view> text = preset_text(name);
  if (named->kind != io::YamlNode::Kind::scalar || !text)
    throw document.error("preset", fmt::format("there is no such preset; expected {}", preset_names()));
  const io::YamlNode preset = io::parsed_yaml(std::string(*text), named->place + ": preset " + name);
  refuse_other_system(document, preset);
  io::LaidBeneath keys = document.lay_beneath(preset, keys_with_alternatives_in(document));
  std::erase(keys.left_out, "system");  // the same
  return fmt::format("{} sets {}", name, fmt::join(keys.added, ", ")) +
         (keys.left_out.empty()
              ? ""
              : fmt::format("; by the case itself and not by the preset: {}", fmt::join(keys.left_out, ", ")));
}

}  // namespace thalweg::driver
