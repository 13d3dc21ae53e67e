#pragma once

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

/// A result file that is complete but not yet written.
struct ResultFile {
  std::filesystem::path path;  ///< relative to the result folder
  std::string content;
  std::string sha256 = {};  ///< empty: not computed yet
};

/// Files that a run may write into its folder.
struct PlannedFiles {
  std::vector<std::filesystem::path> files;  ///< relative to the folder; some may not be written
  /// Folders from which all files of an earlier run are removed: "residuals".
  std::vector<std::filesystem::path> folders;
};

/// Verb that takes a folder of results, and how.
struct Holding {
  std::string verb;
  bool force = false;  ///< also replace files that are not rigcal's, or that were changed
  std::string forced_by = "--force";                  ///< what the user types for that, in messages
  std::function<void(const std::string&)> warn = {};  ///< may be empty
};

/// Folder of a run's results, locked for this run while the object lives. The constructor makes the
/// folder and tests whether it is writable, before any long work. A folder that it made is removed
/// again if it is still empty at the end. A warning says if the file system has no locks.
///
/// The folder's manifest lists the files that rigcal wrote. Any other file, and any listed file
/// that was changed, is not replaced. Links to folders inside the folder are not followed; the
/// folder itself may be a link.
class HeldFolder {
 public:
  /// @throws WriteError  with path and reason
  /// @throws UsageError  another run has taken it
  /// @throws InputError  the file in the place of its manifest is none
  HeldFolder(const std::filesystem::path& out, Holding holding);
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;
  ~HeldFolder();

  /// The path as the user gave it.
  const std::filesystem::path& path() const { return out_; }

  /// Announces, before the work, the files that the run may write. Files of earlier runs with these
  /// names or in these folders are removed together with the run's results, if the run does not
  /// replace them and they are unchanged.
  ///
  /// @throws UsageError, WriteError  as require_replaceable()
  void plan(PlannedFiles planned);

  /// Refuses to replace files that are not rigcal's or that were changed, unless forced. A file
  /// with the same content as the new one may be replaced.
  ///
  /// @throws UsageError  names the files; or a folder on the way to one is a link
  /// @throws WriteError  a folder has the name of a file
  void require_replaceable(const std::vector<ResultFile>& files);

  /// Removes the folders that the living object has made, if they are empty. For a signal handler,
  /// which ends the process before the destructor can run; safe within one.
  static void remove_if_empty();

 private:
  friend class ResultsInWriting;

  /// Folders that go again where they are empty, innermost first.
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
  std::map<std::string, FileState> checked_;  ///< state of the files that may be replaced
  std::set<std::string> swept_;
  PlannedFiles planned_;
};

/// Refuses a result that would replace one of the files it was made from.
///
/// @throws UsageError  naming the file
void require_inputs_kept(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& results,
                         const std::vector<InputFile>& inputs);

/// Writes result files in two steps. add() writes each file next to its target, so that it need not
/// stay in memory. Then all are moved together with the manifest that lists them, so that a full
/// disk leaves the files of an earlier run unchanged.
class ResultsInWriting {
 public:
  /// Both arguments outlive the object.
  ResultsInWriting(HeldFolder& held, const std::vector<InputFile>& inputs)
      : held_(held), inputs_(inputs) {}

  /// @param file  its hash is computed if it is missing
  /// @throws WriteError  with path and reason
  /// @throws UsageError  the file would replace one of `inputs`, or a file that must be kept
  void add(const ResultFile& file);

  /// Moves all files to their targets and removes the remaining planned files of earlier runs.
  /// @throws WriteError  with path and reason; the earlier files are complete then
  void move_into_place();

 private:
  HeldFolder& held_;
  const std::vector<InputFile>& inputs_;
  std::vector<ManifestFile> added_;
  FilesInWriting writing_;
};

/// Writes every file, each whole or not at all: all are written beside their places before the
/// first is moved there, so that a full disk leaves the files of an earlier run as they were.
///
/// @throws WriteError  with path and reason
/// @throws UsageError  a file would replace one of `inputs`, or a file that must be kept; then none
///                     is written
///                     written
void write_results(HeldFolder& held, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs);

/// Removes a file of an earlier run that would contradict this one.
///
/// @throws WriteError  it is there and cannot be removed
void remove_stale(const std::filesystem::path& file);

}  // namespace rigcal::report
