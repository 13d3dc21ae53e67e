#include "report/store/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/error.hpp"
#include "common/file.hpp"
#include "common/uninterrupted.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

/// The folders of `path`, itself included, that are not there yet: outermost last.
std::vector<fs::path> missing_folders(const fs::path& path) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path p = path; !p.empty() && !fs::exists(p, error) && !error; p = p.parent_path()) {
    missing.push_back(p);
  }
  return missing;
}

// A signal handler can reach nothing but a global.
std::atomic<const std::vector<fs::path>*> made_now{nullptr};

}  // namespace

void HeldFolder::remove_if_empty() {
  const std::vector<fs::path>* folders = made_now;
  if (folders == nullptr) return;
  for (const fs::path& folder : *folders) ::rmdir(folder.c_str());
}

HeldFolder::Made::~Made() {
  const Uninterrupted whole;
  made_now = nullptr;
  std::error_code ignored;  // one that is not empty stays
  for (const fs::path& folder : folders) fs::remove(folder, ignored);
}

HeldFolder::HeldFolder(const fs::path& out) {
  const fs::path folder = fs::absolute(out).lexically_normal();
  std::error_code unknown;  // the probe tells
  if (fs::exists(folder, unknown) && !fs::is_directory(folder, unknown))
    throw WriteError(fmt::format("--out {}: is a file; expected a folder", out.string()));
  const Uninterrupted whole;
  made_.folders = missing_folders(folder);
  made_now = &made_.folders;
  const fs::path probe = folder / ".rigcal-probe";
  write_file_atomically(probe, "");
  std::error_code ignored;  // what cannot be removed again does no harm
  fs::remove(probe, ignored);
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw UsageError(
        fmt::format("--out {}: another run of rigcal writes into it; wait for its end, "
                    "or choose another folder",
                    out.string()));
  }
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

void ResultsInWriting::add(const fs::path& path, std::string_view content) {
  require_inputs_kept(out_, {path}, inputs_);
  writing_.add(out_ / path, content);
}

void write_results(const fs::path& out, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs) {
  std::vector<fs::path> paths;
  for (const ResultFile& file : files) paths.push_back(file.path);
  require_inputs_kept(out, paths, inputs);
  ResultsInWriting writing(out, inputs);
  for (const ResultFile& file : files) writing.add(file.path, file.content);
  writing.move_into_place();
}

void remove_stale(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) {
    throw WriteError(fmt::format("{}: of an earlier run, cannot be removed: {}", file.string(),
                                 error.message()));
  }
}

}  // namespace rigcal::report
