// Small text files that are either wholly there or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace thalweg::io {

// Writes `text` under a temporary name beside `path` and renames it into place. Throws RunError.
void write_text_atomically(const std::filesystem::path& path, const std::string& text);

// The same, and it outlasts a loss of power once this returns.
void write_text_durably(const std::filesystem::path& path, const std::string& text);

// Waits until the data of `from` are on the disk, then renames it to `to` and waits for the folder. False if that
// fails.
bool put_on_disk(const std::filesystem::path& from, const std::filesystem::path& to);

// Renames a finished file into place. Throws RunError.
void rename_into_place(const std::filesystem::path& from, const std::filesystem::path& to);

// Creates a folder and its parents if they are missing. Throws RunError.
void make_folder(const std::filesystem::path& path);

// The whole file. Throws InputError if it cannot be read.
std::string read_text(const std::filesystem::path& path);

}  // namespace thalweg::io
