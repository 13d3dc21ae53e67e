#include "report/folder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "common/error.hpp"
#include "common/file.hpp"

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

}  // namespace

void require_writable(const fs::path& out) {
  const fs::path folder = fs::absolute(out).lexically_normal();
  const std::vector<fs::path> made = missing_folders(folder);
  const fs::path probe = folder / ".rigcal-probe";
  write_file_atomically(probe, "");
  std::error_code ignored;  // what cannot be removed again does no harm
  fs::remove(probe, ignored);
  for (const fs::path& path : made) fs::remove(path, ignored);
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

void write_results(const fs::path& out, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs) {
  std::vector<fs::path> paths;
  for (const ResultFile& file : files) paths.push_back(file.path);
  require_inputs_kept(out, paths, inputs);
  for (const ResultFile& file : files) write_file_atomically(out / file.path, file.content);
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
