#include "report/store/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include "common/error.hpp"
#include "common/temporary_name.hpp"
#include "common/uninterrupted.hpp"
#include "report/store/checkpoint.hpp"
#include "report/store/kept_tasks.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

/// Lists `path` and its parents that do not exist yet, innermost first.
std::vector<fs::path> missing_folders(const fs::path& path) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path p = path; !p.empty() && !fs::exists(p, error) && !error; p = p.parent_path()) {
    missing.push_back(p);
  }
  return missing;
}

// A signal handler can access only globals.
std::atomic<const std::vector<fs::path>*> made_now{nullptr};

constexpr const char* kProbeFile = ".rigcal-probe";

/// Maximum number of files that a message names.
constexpr std::size_t kMostFilesNamed = 8;

std::string listed(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kMostFilesNamed);
  std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

/// Finds the first folder between `out` and a file that is a link; std::nullopt if there is none.
std::optional<fs::path> link_within(const fs::path& out, const fs::path& file) {
  fs::path inner;
  for (const fs::path& part : file.parent_path()) {
    inner /= part;
    std::error_code unknown;
    if (fs::is_symlink(out / inner, unknown)) return inner;
  }
  return std::nullopt;
}

/// Whether a file is readable, is not a link, and has this hash.
bool has_hash(const fs::path& file, const std::string& hash) {
  std::error_code unknown;
  try {
    return fs::is_regular_file(fs::symlink_status(file, unknown)) && sha256_of_file(file) == hash;
  } catch (const InputError&) {
    return false;
  }
}

/// Checks, before any work, that no folder has the name of a file to be written.
void require_no_folder(const fs::path& file) {
  std::error_code unknown;
  if (fs::is_directory(fs::symlink_status(file, unknown)))
    throw WriteError(fmt::format("{}: cannot be written: is a folder", file.string()));
}

/// Reads the text of the current manifest; std::nullopt if it cannot be read, a case that gets here
/// only with --force.
std::optional<std::string> manifest_there(const fs::path& out) {
  try {
    const auto file = files_in(out)(kManifestFile);
    return file ? std::optional(file->content) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Whether a file stores the state of a fit for --resume. No manifest lists such a file, because it
/// changes during the fit.
bool is_kept_state(const std::string& path, const fs::path& file) {
  if (path == kCheckpointFile) return is_checkpoint(file);
  return path == kKeptTasksFile && is_kept_tasks(file);
}

}  // namespace

void HeldFolder::remove_if_empty() {
  const std::vector<fs::path>* folders = made_now;
  if (folders == nullptr) return;
  for (const fs::path& folder : *folders) ::rmdir(folder.c_str());
}

HeldFolder::Made::~Made() {
  const Uninterrupted whole;
  made_now = nullptr;
  std::error_code ignored;  // folders that are not empty cannot be removed, and are kept
  for (const fs::path& folder : folders) fs::remove(folder, ignored);
}

HeldFolder::HeldFolder(const fs::path& out, Holding holding)
    : out_(out), holding_(std::move(holding)) {
  const fs::path folder = fs::absolute(out).lexically_normal();
  std::error_code unknown;  // writing the probe reports the error
  if (fs::exists(folder, unknown) && !fs::is_directory(folder, unknown))
    throw WriteError(fmt::format("--out {}: is a file; expected a folder", out.string()));
  {
    const Uninterrupted whole;
    made_.folders = missing_folders(folder);
    made_now = &made_.folders;
    const fs::path probe = folder / kProbeFile;
    write_file_atomically(probe, "");
    std::error_code ignored;  // a leftover probe is harmless
    fs::remove(probe, ignored);
  }
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  try {
    lock();
    require_no_folder(out_ / kManifestFile);
    try {
      listed_ = manifest_files(out_);
    } catch (const InputError& error) {
      if (!holding_.force)
        throw UsageError(fmt::format("{}; {} creates a new one", error.what(), holding_.forced_by));
    }
  } catch (...) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
  for (const char* name : {kProbeFile, kManifestFile, kCheckpointFile}) sweep(name);
  for (const ManifestFile& file : listed_) sweep(file.path);
}

void HeldFolder::lock() {
  locked_ = descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  if (locked_) return;
  const int reason = errno;
  if (descriptor_ >= 0 && reason == EWOULDBLOCK) {
    throw UsageError(
        fmt::format("{}: another run of rigcal writes into it; wait for its end, "
                    "or choose another folder",
                    out_.string()));
  }
  if (holding_.warn)
    holding_.warn(fmt::format(
        "{}: cannot be locked ({}): make sure that no other run writes into it at the same time",
        out_.string(), std::generic_category().message(reason)));
}

void HeldFolder::plan(PlannedFiles planned) {
  planned_ = std::move(planned);
  std::vector<ResultFile> files;
  for (const fs::path& file : planned_.files) files.push_back({file, ""});
  std::vector<fs::path> entered = planned_.folders;
  entered.insert(entered.end(), planned_.result_folders.begin(), planned_.result_folders.end());
  for (const fs::path& folder : entered) {
    if (link_within(out_, folder / "x")) files.push_back({folder / "x", ""});
  }
  require_replaceable(files);
}

bool HeldFolder::is_as_written(const std::string& path, const std::string& coming) {
  const fs::path file = out_ / path;
  std::error_code unknown;
  const fs::file_status status = fs::symlink_status(file, unknown);
  if (!fs::exists(status)) return true;
  if (!fs::is_regular_file(status)) return false;
  const FileState state = state_of_file(file);
  const auto checked = checked_.find(path);
  if (checked != checked_.end() && checked->second == state) return true;
  const std::string hash = sha256_of_file(file);
  const bool own = hash == coming || is_kept_state(path, file) ||
                   std::any_of(listed_.begin(), listed_.end(), [&](const ManifestFile& each) {
                     return each.path == path && each.sha256 == hash;
                   });
  if (own) checked_[path] = state;
  return own;
}

void HeldFolder::sweep(const fs::path& path) {
  // Without the lock another run, even on another machine, may be using the file.
  if (!locked_ || !swept_.insert(path.generic_string()).second || link_within(out_, path)) return;
  remove_left_behind(out_ / path.parent_path(), {path.filename().string()});
}

void HeldFolder::require_replaceable(const std::vector<ResultFile>& files) {
  std::vector<std::string> unlisted;
  std::vector<std::string> changed;
  for (const ResultFile& file : files) {
    if (const auto link = link_within(out_, file.path))
      throw UsageError(
          fmt::format("{}: is a link, and links inside a folder of results are not followed; "
                      "remove it, or choose another folder",
                      (out_ / *link).string()));
    require_no_folder(out_ / file.path);
    sweep(file.path);
    const std::string path = file.path.generic_string();
    if (holding_.force || is_as_written(path, file.sha256)) continue;
    const bool known = std::any_of(listed_.begin(), listed_.end(),
                                   [&](const ManifestFile& each) { return each.path == path; });
    (known ? changed : unlisted).push_back(path);
  }
  if (unlisted.empty() && changed.empty()) return;
  std::string found;
  if (!unlisted.empty()) found = fmt::format("{}: not written by rigcal", listed(unlisted));
  if (!changed.empty()) {
    found += fmt::format("{}{}: changed since rigcal wrote {}", found.empty() ? "" : "; ",
                         listed(changed), changed.size() == 1 ? "it" : "them");
  }
  throw UsageError(
      fmt::format("{}: contains files that {} would replace: {}; expected another folder, or {}",
                  out_.string(), holding_.verb, found, holding_.forced_by));
}

std::vector<fs::path> HeldFolder::left_over(const std::set<std::string>& written) const {
  std::vector<fs::path> paths;
  for (const ManifestFile& each : listed_) {
    const fs::path path = each.path;
    const auto has = [](const std::vector<fs::path>& all, const fs::path& one) {
      return std::find(all.begin(), all.end(), one) != all.end();
    };
    if (written.contains(each.path) || link_within(out_, path)) continue;
    if (!has(planned_.files, path) && !has(planned_.folders, path.parent_path())) continue;
    if (has_hash(out_ / path, each.sha256)) paths.push_back(path);
  }
  return paths;
}

HeldFolder::~HeldFolder() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void require_inputs_kept(const fs::path& out, const std::vector<fs::path>& results,
                         const std::vector<InputFile>& inputs) {
  for (const fs::path& result : results) {
    for (const InputFile& input : inputs) {
      std::error_code error;
      if (fs::equivalent(out / result, input.path, error) && !error) {
        throw UsageError(
            fmt::format("--out {}: the result {} would replace the input {}; choose "
                        "another folder",
                        out.string(), result.string(), input.path));
      }
    }
  }
}

void ResultsInWriting::add(const ResultFile& file) {
  require_inputs_kept(held_.out_, {file.path}, inputs_);
  const std::string hash = sha256_of(file);
  held_.require_replaceable({{file.path, "", hash}});
  writing_.add(held_.out_ / file.path, file.content);
  added_.push_back({file.path.generic_string(), hash, held_.holding_.verb});
}

void ResultsInWriting::move_into_place() {
  std::set<std::string> written;
  for (const ManifestFile& file : added_) written.insert(file.path);
  const std::vector<fs::path> going = held_.left_over(written);
  std::vector<ManifestFile> staying = added_;
  std::vector<ManifestFile> left = added_;
  std::vector<ManifestFile> all = added_;
  for (const ManifestFile& file : held_.listed_) {
    all.push_back(file);
    if (written.contains(file.path)) continue;
    left.push_back(file);
    if (std::find(going.begin(), going.end(), file.path) == going.end()) staying.push_back(file);
  }
  // Renaming starts with a manifest of all old and new files, so that it lists every existing file
  // even if the process ends between two renames.
  const fs::path manifest = held_.out_ / kManifestFile;
  const auto earlier = manifest_there(held_.out_);
  // All texts are made before the uninterruptible section. Running out of memory in that section
  // would end the process, and even freeing a JSON value takes memory.
  const std::string text_of_left = manifest_text(left);
  const std::string text_of_all = manifest_text(all);
  const std::string text_of_staying = manifest_text(staying);
  const Uninterrupted whole;
  writing_.add(manifest, text_of_left);
  FilesInWriting back;  // written before any rename, since memory may have run out afterwards
  if (earlier) back.add(manifest, *earlier);
  write_file_atomically(manifest, text_of_all);
  try {
    writing_.rename_into_place();
  } catch (...) {
    try {
      back.rename_into_place();
    } catch (const WriteError&) {  // the longer manifest is kept, and is valid as well
    }
    if (!earlier) ::unlink(manifest.c_str());
    throw;
  }
  if (!going.empty()) {
    for (const fs::path& path : going) remove_stale(held_.out_ / path);
    write_file_atomically(manifest, text_of_staying);
  }
  held_.listed_ = staying;
}

void write_results(HeldFolder& held, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs) {
  std::vector<fs::path> paths;
  for (const ResultFile& file : files) paths.push_back(file.path);
  require_inputs_kept(held.path(), paths, inputs);
  held.require_replaceable(files);
  ResultsInWriting writing(held, inputs);
  for (const ResultFile& file : files) writing.add(file);
  writing.move_into_place();
}

void remove_stale(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) {
    throw WriteError(fmt::format("{}: file of an earlier run cannot be removed: {}", file.string(),
                                 error.message()));
  }
}

}  // namespace rigcal::report
