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

/// Writes `content` beside `path` and renames it into place, so that a reader sees the old file or
/// the whole new one. Creates missing folders.
///
/// @throws WriteError  with path and reason; no partial file stays behind
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// The same for several files: all are written before the first is renamed to its target.
void write_files_atomically(
    const std::vector<std::pair<std::filesystem::path, std::string_view>>& files);

class TemporaryFile;

/// Files in writing: add() writes each next to its target, and all are renamed together. The
/// destructor removes those that were not renamed.
class FilesInWriting {
 public:
  FilesInWriting();
  FilesInWriting(const FilesInWriting&) = delete;
  FilesInWriting& operator=(const FilesInWriting&) = delete;
  ~FilesInWriting();

  /// Creates missing folders, which are removed again if they stay empty.
  /// @throws WriteError  with path and reason
  void add(const std::filesystem::path& path, std::string_view content);

  /// @throws WriteError  with path and reason
  void rename_into_place();

  /// Removes the files that no object has renamed yet, for a process that ends before their
  /// destructors can run. Safe within a signal handler, as long as there is no Uninterrupted.
  static void remove_all();

 private:
  void make_folders(const std::filesystem::path& folder);
  void remove_made_folders() const;

  std::vector<std::unique_ptr<TemporaryFile>> written_;
  std::vector<std::string> folders_;  ///< created folders, outer ones first
  FilesInWriting* next_ = nullptr;
};

/// The content of a regular file. Never waits for a pipe.
///
/// @param expected  what the file should be, in words: "a campaign file (TOML)"
/// @throws InputError  there is none, it is a folder, pipe or device, has more than `most_bytes`,
/// or
///                     cannot be read
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes,
                      const std::string& expected);

/// Refuses a file that is not regular before some code opens it and waits for a pipe.
///
/// @throws InputError  as read_file()
void require_regular_file(const std::filesystem::path& path, const std::string& expected);

/// State of a file at one moment: any change or replacement gives another state.
struct FileState {
  std::string path;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;  ///< since 1970: when its content or its inode changed last
  bool operator==(const FileState&) const = default;
};

/// State of an existing file; of a missing one only its path.
FileState state_of_file(const std::filesystem::path& path);

/// SHA-256 of a file that was read since `before`, so that the hash is of the bytes that were read.
///
/// @throws InputError  it cannot be read, or has changed since
std::string sha256_of_unchanged(const FileState& before);

/// SHA-256 of a file, 64 lower-case hex digits. Reads in blocks.
///
/// @throws InputError  the file cannot be read
std::string sha256_of_file(const std::filesystem::path& path);

/// SHA-256 of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace rigcal
