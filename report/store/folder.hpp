#pragma once

#include <any>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/file.hpp"
#include "report/store/manifest.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// Complete content of a result file.
struct ResultFile {
  std::filesystem::path path;  ///< relative to the result folder
  std::string content;
  std::string sha256 = {};  ///< empty: not computed yet
  /// The object that this process wrote the content from, as std::shared_ptr<const T> (made() in
  /// report/store/result_files.hpp); empty for a file that was read.
  std::any object = {};
};

/// Returns the hash of the content, which is computed if it is not known yet.
inline std::string sha256_of(const ResultFile& file) {
  return file.sha256.empty() ? sha256_of_text(file.content) : file.sha256;
}

/// Files that a run may write into its folder.
struct PlannedFiles {
  std::vector<std::filesystem::path> files;  ///< relative to the folder; the run may omit some
  /// Folders from which all files of an earlier run are removed: "residuals".
  std::vector<std::filesystem::path> folders;
  /// Folders of separate results that the run writes, each with its own manifest.
  std::vector<std::filesystem::path> result_folders = {};
};

/// How a verb takes over a result folder.
struct Holding {
  std::string verb;
  bool force = false;  ///< also replace files that rigcal did not write or that were changed
  std::string forced_by = "--force";                  ///< how a user sets `force`, for messages
  std::function<void(const std::string&)> warn = {};  ///< may be empty
};

/// Result folder of a run, locked for this run during the object's lifetime. The constructor
/// creates the folder and tests whether it is writable, before any long work. The destructor
/// removes a folder that the constructor created, if it is still empty. A warning is given if the
/// file system does not support locks.
///
/// The folder's manifest lists the files that rigcal wrote. Other files, and listed files that were
/// changed, are not replaced. Links to folders inside the folder are not followed; the folder
/// itself may be a link.
class HeldFolder {
 public:
  /// @throws WriteError  if the folder cannot be created or written; names path and reason
  /// @throws UsageError  if another run has locked the folder, or its manifest is invalid and
  ///                     `force` is not set
  HeldFolder(const std::filesystem::path& out, Holding holding);
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;
  ~HeldFolder();

  /// The path as the user gave it.
  const std::filesystem::path& path() const { return out_; }

  /// Announces, before any work, the files that the run may write. When the results are moved into
  /// place, unchanged files from earlier runs are removed if they have these names or are in these
  /// folders, and the run did not replace them.
  ///
  /// @throws UsageError, WriteError  under the conditions of require_replaceable()
  void plan(PlannedFiles planned);

  /// Refuses to replace files that rigcal did not write or that were changed, unless forced. A file
  /// with the same content as the new one may be replaced.
  ///
  /// @throws UsageError  if a file must not be replaced, or a folder on its path is a link; names
  /// it
  /// @throws WriteError  if a folder has the name of a file
  void require_replaceable(const std::vector<ResultFile>& files);

  /// Removes the folders that the existing object created, if they are empty. Made for signal
  /// handlers, which end the process before the destructor can run; async-signal-safe.
  static void remove_if_empty();

 private:
  friend class ResultsInWriting;

  /// Folders to remove at the end if they are empty, innermost first.
  struct Made {
    std::vector<std::filesystem::path> folders;
    ~Made();
  };

  void lock();
  bool is_as_written(const std::string& path, const std::string& coming);
  void sweep(const std::filesystem::path& path);
  std::vector<std::filesystem::path> left_over(const std::set<std::string>& written) const;

  std::filesystem::path out_;
  Holding holding_;
  Made made_;
  int descriptor_ = -1;
  bool locked_ = false;
  std::vector<ManifestFile> listed_;
  std::map<std::string, FileState> checked_;  ///< states of files that were found replaceable
  std::set<std::string> swept_;
  PlannedFiles planned_;
};

/// Checks that no result replaces one of the files that it is made from.
///
/// @throws UsageError  if a result would replace an input; names the file
void require_inputs_kept(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& results,
                         const std::vector<InputFile>& inputs);

/// Writes result files in two steps. add() writes each file next to its target, which frees its
/// memory. move_into_place() then moves all files and the manifest that lists them. A full disk
/// thus leaves the files from an earlier run unchanged.
class ResultsInWriting {
 public:
  /// Borrows both arguments.
  ResultsInWriting(HeldFolder& held, const std::vector<InputFile>& inputs)
      : held_(held), inputs_(inputs) {}

  /// Writes a file next to its target.
  ///
  /// @param file  its hash is computed if it is missing
  /// @throws WriteError  if the file cannot be written; names path and reason
  /// @throws UsageError  if the file would replace one of `inputs` or a file that must be kept
  void add(const ResultFile& file);

  /// Moves all files to their targets, and removes planned files that remain from earlier runs.
  ///
  /// @throws WriteError  if a file cannot be moved; the earlier files are then still complete
  void move_into_place();

 private:
  HeldFolder& held_;
  const std::vector<InputFile>& inputs_;
  std::vector<ManifestFile> added_;
  FilesInWriting writing_;
};

/// Writes all files with ResultsInWriting: each completely or not at all.
///
/// @throws WriteError  if a file cannot be written; names path and reason
/// @throws UsageError  if a file would replace one of `inputs` or a file that must be kept; no file
///                     is written then
void write_results(HeldFolder& held, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs);

/// Removes a file from an earlier run that would contradict the results of this one.
///
/// @throws WriteError  if the file exists and cannot be removed
void remove_stale(const std::filesystem::path& file);

}  // namespace rigcal::report
