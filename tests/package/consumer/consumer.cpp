// Fits a campaign, prints the estimates and writes the report: consumer campaign.toml results
#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>
#include <rigcal/rigcal.hpp>
#include <utility>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    using namespace rigcal;
    const auto campaign =
        std::make_shared<const datasets::Campaign>(datasets::load_campaign(argv[1]));
    report::HeldFolder results(argv[2], {"fit"});
    const std::atomic<bool> cancel = false;  // set it from another thread to end the fit
    report::JobTerms terms{.command = "consumer", .options = {}, .threads = 2, .cancel = cancel};
    terms.hold = [&](report::PlannedFiles planned) { results.plan(std::move(planned)); };
    report::JobResult job = report::fit_job(campaign, {}, terms);
    for (const calib::FittedParameter& each : job.fit->fit.parameters)
      if (each.fitted) std::printf("%s %.6g %s\n", each.key.c_str(), each.value, each.unit.c_str());
    report::write_job(results, 2, std::move(job));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
  return 0;
}
