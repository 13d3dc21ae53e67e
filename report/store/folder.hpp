#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/file.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// A result file that is complete but not yet written.
struct ResultFile {
  std::filesystem::path path;  ///< relative to the result folder
  std::string content;
};

/// The folder of a run's results, which is this run's alone as long as the object lives. Makes it
/// and tries whether files can be made in it, before any long work; a folder that it made and that
/// is still empty in the end goes again. Where the file system has no locks, none is held.
class HeldFolder {
 public:
  /// @throws WriteError  with path and reason
  /// @throws UsageError  another run holds it
  explicit HeldFolder(const std::filesystem::path& out);
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;
  ~HeldFolder();

  /// Removes what the one that lives has made, if it is empty: for a handler of signals, which ends
  /// the process before the destructor can. Safe within one.
  static void remove_if_empty();

 private:
  /// Folders that go again where they are empty, innermost first.
  struct Made {
    std::vector<std::filesystem::path> folders;
    ~Made();
  };
  Made made_;
  int descriptor_ = -1;
};

/// Refuses a result that would replace one of the files it was made from.
///
/// @throws UsageError  naming the file
void require_inputs_kept(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& results,
                         const std::vector<InputFile>& inputs);

/// Result files on their way: each is written beside its place when it is added, so that it need
/// not stay in memory until the last one is known, and all are moved there together, so that a full
/// disk leaves the files of an earlier run as they were.
class ResultsInWriting {
 public:
  /// @param out, inputs  of the run; both outlive the object
  ResultsInWriting(const std::filesystem::path& out, const std::vector<InputFile>& inputs)
      : out_(out), inputs_(inputs) {}

  /// @param path  relative to the result folder
  /// @throws WriteError  with path and reason
  /// @throws UsageError  it would replace one of `inputs`; then none is written
  void add(const std::filesystem::path& path, std::string_view content);

  /// @throws WriteError  with path and reason
  void move_into_place() { writing_.rename_into_place(); }

 private:
  const std::filesystem::path& out_;
  const std::vector<InputFile>& inputs_;
  FilesInWriting writing_;
};

/// Writes every file, each whole or not at all: all are written beside their places before the
/// first is moved there, so that a full disk leaves the files of an earlier run as they were.
///
/// @throws WriteError  with path and reason
/// @throws UsageError  a file would replace one of `inputs`; then none is written
void write_results(const std::filesystem::path& out, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs);

/// Removes a file of an earlier run that would contradict this one.
///
/// @throws WriteError  it is there and cannot be removed
void remove_stale(const std::filesystem::path& file);

}  // namespace rigcal::report
