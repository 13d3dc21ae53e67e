#include <fmt/format.h>

#include <algorithm>

#include "common/file.hpp"
#include "report/comparison/comparison.hpp"
#include "report/comparison/comparison_curves.hpp"
#include "report/job/job.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {

JobResult comparison_job(const std::vector<std::filesystem::path>& folders, const JobTerms& terms) {
  if (folders.size() < 2)
    throw UsageError("compare: expected at least two result folders; the first is the reference");
  for (auto folder = folders.begin(); folder != folders.end(); ++folder) {
    const auto same = [&](const auto& other) {
      return std::filesystem::equivalent(*folder, other);
    };
    if (std::any_of(folders.begin(), folder, same))
      throw UsageError(fmt::format("compare: {} is given twice", folder->string()));
  }
  const std::vector<Compared> results = load_compared(folders);
  terms.hold({{"comparison.json", "report.html"}, {"overlay"}});
  Provenance provenance;
  provenance.command = terms.command;
  for (const Compared& each : results)
    provenance.inputs.push_back({each.file.string(), sha256_of_file(each.file)});
  StoredComparison comparison = compared(results, provenance);
  JobResult job;
  job.code = comparison.status == "done" ? ExitCode::done : ExitCode::no_result;
  job.files = comparison_curves(results);
  name_files(job.files, comparison.provenance);
  job.files.push_back(json_file("comparison.json", std::move(comparison)));
  job.first = {"comparison.json"};
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace rigcal::report
