#include "io/pvd_index.hpp"

#include "io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace thalweg::io {
namespace {

// The text between two marks after position `from`; moves `from` behind it. Empty optional: no more.
std::optional<std::string> next_between(const std::string& text, const std::string& before, const std::string& after,
                                        std::size_t& from) {
  const std::size_t start = text.find(before, from);
  if (start == std::string::npos) return std::nullopt;
  const std::size_t end = text.find(after, start + before.size());
  if (end == std::string::npos) return std::nullopt;
  from = end + after.size();
  return text.substr(start + before.size(), end - start - before.size());
}

}  // namespace

PvdIndex::PvdIndex(std::filesystem::path path, std::optional<double> continue_from) : path_(std::move(path)) {
  if (!continue_from || !std::filesystem::exists(path_)) return;
  const std::string text = read_text(path_);
  std::size_t at = 0;
  while (const auto time_text = next_between(text, "timestep=\"", "\"", at)) {
    const auto file = next_between(text, "file=\"", "\"", at);
    double time = 0.0;
    const auto parsed = std::from_chars(time_text->data(), time_text->data() + time_text->size(), time);
    if (file && parsed.ec == std::errc() && time <= *continue_from) entries_.push_back({time, *file});
  }
}

void PvdIndex::add(double time, const std::filesystem::path& file) {
  std::erase_if(entries_, [time](const Entry& entry) { return entry.time == time; });
  entries_.push_back({time, file.generic_string()});
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const Entry& entry : entries_)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time, entry.file);
  write_text_atomically(path_, text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace thalweg::io
