#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>

#include "calib/problem/scaled_svd.hpp"
#include "calib/search/optimum.hpp"
#include "calib/search/search.hpp"
#include "datasets/prepare/load_record.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinRel;
using datasets::Waveform;

/// Records of a campaign in ../shared/data; empty if they are not available.
struct Recorded {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;
};

std::optional<Recorded> recorded(const std::string& path) {
  const std::filesystem::path file = std::filesystem::path(RIGCAL_RECORDINGS_DIR) / path;
  if (!std::filesystem::exists(file)) {
    WARN("skipped: " << file << " is absent");
    return std::nullopt;
  }
  Recorded result{datasets::load_campaign(file.string()), {}};
  result.records = datasets::load_records(result.campaign, {datasets::Use::fit}, 1, true);
  for (datasets::Condition& each : result.campaign.conditions) {
    if (each.use != datasets::Use::fit) each.use = datasets::Use::ignore;
  }
  return result;
}

const Reason* further_starts_reason(const Fit& fit) {
  const auto& reasons = fit.assessment.parameters.reasons;
  const auto found = std::find_if(reasons.begin(), reasons.end(), [](const Reason& reason) {
    return reason.code == "further_starts";
  });
  return found == reasons.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("further starts: where the campaign's misleads, one that leads lower is the result",
          "[calib]") {
  const auto boom = recorded("excavator_dspace/boom_up_two_records.toml");
  if (!boom) return;
  FitOptions options;
  options.further_starts = 3;
  const Fit found = fit(boom->campaign, boom->records, options);
  CHECK(found.status == FitStatus::converged);
  CHECK_THAT(found.starts.front().final_cost, WithinRel(121220.85, 1e-4));
  CHECK(found.cost < 61500.0);
  CHECK(found.best_start > 1);
  REQUIRE(found.further_starts);
  CHECK(found.further_starts->looked_at == 3);
  CHECK(found.further_starts->followed >= 1);
  REQUIRE(further_starts_reason(found) != nullptr);
  CHECK_THAT(further_starts_reason(found)->words, Contains("reached a lower cost"));
  // The results are bitwise identical for any number of threads.
  options.threads = 2;
  const Fit threaded = fit(boom->campaign, boom->records, options);
  CHECK(threaded.cost == found.cost);
  CHECK(threaded.evaluations == found.evaluations);
}

TEST_CASE("further starts: a lift whose residuals are large ends at its minimum", "[calib]") {
  const auto lift = recorded("patu_lift/campaign.toml");
  if (!lift) return;
  FitOptions options;
  options.further_starts = 3;
  const Fit found = fit(lift->campaign, lift->records, options);
  CHECK(found.status == FitStatus::converged);
  CHECK_THAT(found.cost, WithinRel(30244.06, 1e-6));
}

TEST_CASE("further starts: where none leads lower the result is that of one start", "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(500, 500.0, 1);
  FitOptions options;
  const Fit alone = fit(twin.campaign, records, options);
  options.further_starts = 3;
  const Fit found = fit(twin.campaign, records, options);
  CHECK(found.cost == alone.cost);
  CHECK(found.best_start == 1);
  CHECK(found.starts.size() == 1);
  for (std::size_t j = 0; j < alone.parameters.size(); ++j)
    CHECK(found.parameters[j].value == alone.parameters[j].value);
  REQUIRE(found.further_starts);
  CHECK(found.further_starts->looked_at == 3);
  CHECK(found.further_starts->followed == 0);
  CHECK(found.further_starts->as_low > 0);
  REQUIRE(further_starts_reason(found) != nullptr);
  CHECK(further_starts_reason(found)->state == AspectState::note);
  CHECK_THAT(further_starts_reason(found)->words, Contains("none reached a lower cost"));
  CHECK(found.evaluations > alone.evaluations);
  // If the user specifies the number of starts, no further starts are evaluated, either.
  options.starts = 2;
  CHECK_FALSE(fit(twin.campaign, records, options).further_starts);
}

TEST_CASE("further starts: a budget ends them, and the result stays", "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(500, 500.0, 1);
  FitOptions options;
  const Fit alone = fit(twin.campaign, records, options);
  options.further_starts = 3;
  options.max_evaluations = alone.evaluations + 2;
  const Fit found = fit(twin.campaign, records, options);
  CHECK(found.cost == alone.cost);
  REQUIRE(found.further_starts);
  CHECK(found.further_starts->looked_at < 3);
}

TEST_CASE("further starts: a start that is stopped at no minimum goes on with them", "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(500, 500.0, 1);
  FitOptions options;
  options.max_iterations = 1;
  REQUIRE(fit(twin.campaign, records, options).status == FitStatus::stopped);
  options.further_starts = 2;
  const Fit found = fit(twin.campaign, records, options);
  CHECK(found.starts.size() == 3);
  CHECK(std::any_of(found.warnings.begin(), found.warnings.end(), [](const std::string& text) {
    return text.find("2 further starts were made") != std::string::npos;
  }));
}

TEST_CASE("optimum: the valley that a search stopped in is named", "[calib]") {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("bulk_modulus", 600e6, 70e6, 7000e6);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("sine", Waveform::sine, 5.0, 0.01);  // in this signal, mass and oil are hard to separate
  const auto records = twin.records(2000, 500.0, 1);
  const Problem problem = problem_of(twin, records);
  Budget budget;
  Evaluator evaluator(problem, budget);
  const FitOptions options;
  REQUIRE(Search(problem, evaluator, options).run(problem.start()).status == FitStatus::converged);
  const Evaluation optimum = evaluator.best();
  CHECK(far_from_minimum(problem, optimum, check_optimum(problem, optimum)).empty());
  const ScaledSvd svd(linearise(problem, optimum).jacobian, 1e-8);
  const Eigen::VectorXd along = svd.inverse_lengths().cwiseProduct(svd.V().col(2));
  std::vector<double> z = optimum.z;
  for (std::size_t j = 0; j < z.size(); ++j)
    z[j] += along(static_cast<Eigen::Index>(j)) / svd.singular_values()(2);  // one standard error
  const Evaluation there = evaluate_at(problem, z, 1);
  const OptimumCheck check = check_optimum(problem, there);
  REQUIRE(there.ok);
  REQUIRE_FALSE(check.is_minimum());
  const std::string words = far_from_minimum(problem, there, check);
  CHECK_THAT(words, Contains("variance of a residual") && Contains("a minimum leaves 0.01"));
  Eigen::Index most = 0;
  svd.V().col(2).cwiseAbs().maxCoeff(&most);
  CHECK_THAT(words, Contains("along") && Contains(problem.name(static_cast<std::size_t>(most))));
}

TEST_CASE("optimum: a bound that the cost presses against is named", "[calib]") {
  Twin twin;
  twin.free("mass", 40.0, 20.0, 60.0);  // true value 85 kg
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("square", Waveform::square, 2.0, 0.01);
  const auto records = twin.records(500, 500.0, 1);
  const Problem problem = problem_of(twin, records);
  const Evaluation there =
      evaluate_at(problem, std::vector<double>{1.0, problem.map.to_unit(1, 0.0405e-3)}, 1);
  REQUIRE(there.ok);
  const OptimumCheck check = check_optimum(problem, there);
  REQUIRE(check.active_bound[0]);
  REQUIRE_FALSE(check.is_minimum());
  CHECK_THAT(far_from_minimum(problem, there, check),
             Contains("active bound: mass_kg") && Contains("a prior or a known value"));
}

}  // namespace rigcal::calib
