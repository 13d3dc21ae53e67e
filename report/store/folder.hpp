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
  std::string sha256 = {};  ///< empty: nobody has asked for it yet
};

/// What a run may leave in its folder.
struct PlannedFiles {
  std::vector<std::filesystem::path> files;  ///< relative to the folder; not all need come
  /// Of which nothing of an earlier run stays: "residuals".
  std::vector<std::filesystem::path> folders;
};

/// Who holds a folder of results, and on what terms.
struct Holding {
  std::string verb;
  bool force = false;                 ///< replaces what is not rigcal's, or was changed since
  std::string forced_by = "--force";  ///< what a user says to have that
  std::function<void(const std::string&)> warn = {};  ///< may be empty
};

/// The folder of a run's results, which is this run's alone as long as the object lives. Makes it
/// and tries whether files can be made in it, before any long work; a folder that it made and that
/// is still empty in the end goes again. Where the file system has no locks it says so.
///
/// It knows by the folder's manifest what rigcal wrote there, and keeps all else: a file that the
/// manifest does not list, or that was changed since, is not replaced. Links to folders inside it
/// are not followed; it may be one itself.
class HeldFolder {
 public:
  /// @throws WriteError  with path and reason
  /// @throws UsageError  another run holds it
  /// @throws InputError  its manifest is none
  HeldFolder(const std::filesystem::path& out, Holding holding);
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;
  ~HeldFolder();

  /// As it was given.
  const std::filesystem::path& path() const { return out_; }

  /// Says before the work what the run may write. What earlier runs left by these names, and in
  /// these folders, goes with the run's results where it is not among them and is as rigcal wrote
  /// it.
  ///
  /// @throws UsageError, WriteError  as require_replaceable()
  void plan(PlannedFiles planned);

  /// Refuses to replace what is not rigcal's, or was changed since, unless that is forced. A file
  /// whose bytes are those that shall come is no loss.
  ///
  /// @throws UsageError  naming the files; or a folder on the way to one is a link
  /// @throws WriteError  a folder has the name of one
  void require_replaceable(const std::vector<ResultFile>& files);

  /// Removes what the one that lives has made, if it is empty: for a handler of signals, which ends
  /// the process before the destructor can. Safe within one.
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
  std::map<std::string, FileState> checked_;  ///< that may be replaced as they stand
  std::set<std::string> swept_;
  PlannedFiles planned_;
};

/// Refuses a result that would replace one of the files it was made from.
///
/// @throws UsageError  naming the file
void require_inputs_kept(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& results,
                         const std::vector<InputFile>& inputs);

/// Result files on their way: each is written beside its place when it is added, so that it need
/// not stay in memory until the last one is known, and all are moved there together with the
/// manifest that lists them, so that a full disk leaves the files of an earlier run as they were.
class ResultsInWriting {
 public:
  /// @param held, inputs  of the run; both outlive the object
  ResultsInWriting(HeldFolder& held, const std::vector<InputFile>& inputs)
      : held_(held), inputs_(inputs) {}

  /// @param file  its hash is made where it has none
  /// @throws WriteError  with path and reason
  /// @throws UsageError  it would replace one of `inputs`, or what the folder keeps
  void add(const ResultFile& file);

  /// And takes away what earlier runs left of the planned files.
  /// @throws WriteError  with path and reason; the earlier set is whole then
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
/// @throws UsageError  a file would replace one of `inputs`, or what the folder keeps; then none is
///                     written
void write_results(HeldFolder& held, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs);

/// Removes a file of an earlier run that would contradict this one.
///
/// @throws WriteError  it is there and cannot be removed
void remove_stale(const std::filesystem::path& file);

}  // namespace rigcal::report
