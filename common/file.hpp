#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal {

/// Writes `content` to a temporary file next to `path` and renames it into place, so that a reader
/// sees either the old file or the complete new one. Creates missing folders.
///
/// @throws WriteError  if this fails, with path and reason; no partial file is left behind
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Like write_file_atomically(), but for several files: all are written before the first is
/// renamed.
void write_files_atomically(
    const std::vector<std::pair<std::filesystem::path, std::string_view>>& files);

class TemporaryFile;

/// Files that are being written. add() writes each file next to its target, and rename_into_place()
/// renames all of them together. The destructor removes those that were not renamed.
class FilesInWriting {
 public:
  FilesInWriting();
  FilesInWriting(const FilesInWriting&) = delete;
  FilesInWriting& operator=(const FilesInWriting&) = delete;
  ~FilesInWriting();

  /// Writes a file. Creates missing folders, which are removed again if they remain empty.
  /// @throws WriteError  if this fails, with path and reason
  void add(const std::filesystem::path& path, std::string_view content);

  /// Renames all files to their targets.
  /// @throws WriteError  if this fails, with path and reason
  void rename_into_place();

  /// Removes all files that have not been renamed. Meant for a process that ends without running
  /// destructors. Safe within a signal handler as long as no Uninterrupted exists.
  static void remove_all();

 private:
  void make_folders(const std::filesystem::path& folder);
  void remove_made_folders() const;

  std::vector<std::unique_ptr<TemporaryFile>> written_;
  std::vector<std::string> folders_;  ///< created folders, outer ones first
  FilesInWriting* next_ = nullptr;
};

/// Returns the content of a regular file. Never blocks on a pipe.
///
/// @param expected  description of the expected file: "a campaign file (TOML)"
/// @throws InputError  if there is no such file, or if it is a folder, pipe or device, has more
///                     than `most_bytes`, or cannot be read
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes,
                      const std::string& expected);

/// Rejects a file that is not regular. Called before other code opens the file, because opening a
/// pipe could block.
///
/// @throws InputError  under the conditions of read_file()
void require_regular_file(const std::filesystem::path& path, const std::string& expected);

/// State of a file at one moment. Any change or replacement gives a different state.
struct FileState {
  std::string path;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;  ///< time since 1970 of the last change to content or inode
  bool operator==(const FileState&) const = default;
};

/// Returns the state of a file; for a missing file, only its path.
FileState state_of_file(const std::filesystem::path& path);

/// Returns the SHA-256 of a file that has not changed since `before`. If the file was read after
/// `before`, this is the hash of the bytes that were read.
///
/// @throws InputError  if the file cannot be read or has changed since `before`
std::string sha256_of_unchanged(const FileState& before);

/// SHA-256 of a file, 64 lower-case hex digits. Reads in blocks.
///
/// @throws InputError  if the file cannot be read
std::string sha256_of_file(const std::filesystem::path& path);

std::string sha256_of_text(std::string_view text);

}  // namespace rigcal
