// Files that are either wholly there or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::io {

// Writes `text` under a temporary name beside `path` and renames it into place. Several processes may write one file at
// once, as the ranks of a failed run do: each under a name of its own. Throws RunError.
void write_text_atomically(const std::filesystem::path& path, const std::string& text);

// The same by one process, and it outlasts a loss of power once this returns.
void write_text_durably(const std::filesystem::path& path, const std::string& text);

// Waits until the data of a file, or the names in a folder, are on the disk. False if that fails.
bool put_on_disk(const std::filesystem::path& path);

// Waits until the data of `from` are on the disk, then renames it to `to` and waits for the folder. False if that
// fails.
bool put_on_disk(const std::filesystem::path& from, const std::filesystem::path& to);

// True if a kill has left a file of this name: unfinished (NAME.partial or NAME.partial.PROCESS), or made beside it
// by MPI-IO while it opened it (Open MPI's NAME.partial.locktest.0).
bool is_left_by_a_kill(const std::filesystem::path& path);

// Creates an empty file, or empties one; false if that fails.
bool create_file(const std::filesystem::path& path);

// True if an empty file could be created under this name; leaves nothing behind.
bool can_create(const std::filesystem::path& path);

// Reserves `bytes` bytes of the file from `offset` on; false if the disk has no room. A collective write through MPI-IO
// does not always report that the disk is full (Open MPI's does not), so the room is taken beforehand. Where the file
// system cannot reserve it (NFS before 4.2, Lustre before 2.14), zeros are written, but only from `written_to` on.
bool reserve_on_disk(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t bytes,
                     std::uint64_t written_to = 0);

// Writes `bytes` zeros from `offset` on and waits until they are on the disk; false if that fails.
bool fill_with_zeros(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t bytes);

// Creates a folder and its parents if they are missing; their names outlast a loss of power. Throws RunError.
void make_folder(const std::filesystem::path& path);

// Paths of what a folder holds, in no order; none if there is no such folder. Throws RunError if it cannot be listed:
// it may hold anything.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

// Removes a file, or a folder with all that it holds, if it is there. Throws RunError if it stays.
void remove_entry(const std::filesystem::path& path);

// Throws InputError, which says why, if a file cannot be opened for reading.
void check_readable(const std::filesystem::path& path);

// The whole file. Throws InputError if it cannot be read.
std::string read_text(const std::filesystem::path& path);

}  // namespace thalweg::io
