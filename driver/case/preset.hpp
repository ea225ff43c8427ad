// Presets: settings by name (`preset: zhang2022`), laid beneath a case, whose own keys win. Each is a file in
// driver/presets, compiled in.
#pragma once

#include "io/text/yaml_document.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace thalweg::driver {

// The YAML of a preset; none of that name: empty.
std::optional<std::string_view> preset_text(const std::string& name);

// "a, b, c".
std::string preset_names();

// Lays the preset that the document names, if it names one, beneath it, without the keys in place of which the case
// gives others (a restitution in place of a damping). Returns what `thalweg check` says of it, empty without a preset.
// Throws InputError where there is no such preset, or the case has another system than it is for.
std::string lay_preset_beneath(io::YamlDocument& document);

}  // namespace thalweg::driver
