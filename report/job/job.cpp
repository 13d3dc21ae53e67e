#include "report/job/job.hpp"

#include "report/page/page.hpp"

namespace rigcal::report {

EarlierFit FitSource::read(model::PlantKind plant) const {
  return made ? *made : read_fit(file, plant);
}

WrittenResult write_job(HeldFolder& held, int threads, JobResult job) {
  WrittenResult written;
  if (job.fit) {
    written = write_result(held, threads, job.fit->result());
  } else {
    if (!job.printed) written.documents = add_page(held.path(), threads, job.files);
    write_results(held, job.files, job.inputs);
    for (const ResultFile& file : job.files) written.files.push_back(file.path);
    written.json = job.printed ? json_text(job.printed->json) : job.files.back().content;
  }
  if (job.written) job.written();
  return written;
}

std::string FitSource::name() const { return made ? "fit" : file.string(); }

std::vector<std::filesystem::path> FitSource::inputs() const {
  if (file.empty()) return {};
  return {file};
}

}  // namespace rigcal::report
