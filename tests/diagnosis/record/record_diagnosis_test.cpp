#include "diagnosis/record/record_diagnosis.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal;
using namespace rigcal::diagnosis;
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// Returns a record with a medium leak that is certain and explains everything.
RecordDiagnosis sure_record() {
  RecordDiagnosis record;
  record.fit.coefficient = record.estimate.coefficient = 0.4;
  record.estimate.share_slope = 0.375;
  record.fit.parity_rms_m = 1e-3;
  record.fit.misfit_rms_m = 1e-5;
  record.fit.noise_rms_m = 1e-5;
  record.estimate.share = 0.15;
  record.estimate.probability = {0.0, 0.0, 1.0, 0.0, 0.0};
  record.estimate.most_probable = LeakClass::medium;
  record.estimate.leak_score = 20.0;
  return record;
}

SignalErrors known_errors() {
  SignalErrors errors;
  errors.repeat_m = 1e-5;
  errors.repeat_freedom = 4;
  errors.healthy_m = 1e-6;
  return errors;
}

RecordDiagnosis judged(RecordDiagnosis record, const SignalErrors& errors = known_errors(),
                       const datasets::DiagnosisSettings& settings = {}) {
  judge(record, errors, 0.0, settings);
  return record;
}

std::string told(const RecordDiagnosis& record) {
  std::string text;
  for (const std::string& each : record.warnings) text += each + "\n";
  return text;
}

/// Returns a record in which a leak reduces the residual from 1 to `left`, without noise, so that
/// left^2 of the power is unexplained.
RecordDiagnosis leaving(double left) {
  RecordDiagnosis record = sure_record();
  record.fit.noise_rms_m = 0.0;
  record.fit.misfit_rms_m = 1e-3 * left;
  return record;
}

}  // namespace

TEST_CASE("judge: a sure leak has its class and nothing to be warned of", "[diagnosis]") {
  const auto record = judged(sure_record());
  CHECK(record.leak.class_ == LeakClass::medium);
  CHECK(record.explained_by_leak == true);
  CHECK(record.leak.leak_share_percent == 15.0);
  CHECK(record.unbounded_leakage_coefficient == 0.4);
  CHECK_THAT(record.log_slope.value(), Catch::WithinRel(0.375 * 0.4 / 0.15, 1e-12));
  CHECK(told(record).empty());
}

TEST_CASE("judge: undecided below the least probability", "[diagnosis]") {
  RecordDiagnosis torn = sure_record();
  torn.estimate.probability = {0.0, 0.4, 0.45, 0.15, 0.0};
  CHECK_FALSE(judged(torn).leak.class_);
  datasets::DiagnosisSettings bold;
  bold.least_probability = 0.45;
  CHECK(judged(torn, known_errors(), bold).leak.class_ == LeakClass::medium);
}

TEST_CASE("judge: from a twentieth unexplained on told of, from a third not classified",
          "[diagnosis]") {
  CHECK(told(judged(leaving(std::sqrt(0.045)))).empty());
  const auto partly = judged(leaving(std::sqrt(0.055)));
  CHECK_THAT(told(partly), Contains("there may be another fault"));
  CHECK(partly.leak.class_ == LeakClass::medium);
  CHECK(judged(leaving(std::sqrt(0.32))).explained_by_leak == true);
  const auto other = judged(leaving(std::sqrt(0.35)));
  CHECK(other.explained_by_leak == false);
  CHECK_FALSE(other.leak.class_);
  CHECK_THAT(told(other), StartsWith("not explained by a leak"));
}

TEST_CASE("judge: a leak below zero by more than its error has no class, and says why",
          "[diagnosis]") {
  RecordDiagnosis fast = sure_record();
  fast.estimate.share = 0.0;
  fast.fit.coefficient = -0.1;
  fast.estimate.ci95 = {-0.12, -0.08};
  CHECK(told(judged(fast)).empty());
  fast.estimate.incompatible = true;
  CHECK_FALSE(judged(fast).leak.class_);
  CHECK_THAT(told(judged(fast)), StartsWith("incompatible with the model") &&
                                     Contains("-0.1 (-0.12 to -0.08)") &&
                                     Contains("supply or valve"));
}

TEST_CASE("judge: no class of a share that cannot be", "[diagnosis]") {
  RecordDiagnosis beyond = sure_record();
  beyond.estimate.share = 4.99;
  beyond.fit.coefficient = 10.0;
  CHECK_FALSE(judged(beyond).leak.class_);
  CHECK_THAT(told(judged(beyond)), StartsWith("a coefficient of 10 would leak more than"));
}

TEST_CASE("judge: a plateau is told of by the relative slope", "[diagnosis]") {
  // The relative slope is d ln share / d ln C = slope C / share.
  RecordDiagnosis flat = sure_record();
  flat.fit.coefficient = 0.02;  // 0.375 * 0.02 / 0.15 = 0.05
  CHECK_THAT(told(judged(flat)), Contains("the share hardly depends on the coefficient"));
  CHECK_THAT(told(judged(flat)), Contains("d ln C = 0.05"));
  flat.fit.coefficient = 0.06;  // relative slope 0.15
  CHECK(told(judged(flat)).empty());
  // A share that falls equally fast is not a plateau, and a share of zero is not judged.
  flat.estimate.share_slope = -0.375;
  CHECK(told(judged(flat)).empty());
  flat.estimate.share = 0.0;
  CHECK(told(judged(flat)).empty());
}

TEST_CASE("judge: what is not in the interval is told", "[diagnosis]") {
  SignalErrors errors = known_errors();
  errors.repeat_m.reset();
  CHECK_THAT(told(judged(sure_record(), errors)), StartsWith("no repeats of this signal"));
  errors = known_errors();
  errors.healthy_m.reset();
  CHECK_THAT(told(judged(sure_record(), errors)), StartsWith("no healthy record of this signal"));
  RecordDiagnosis corrected = sure_record();
  corrected.reference_repeats = 5;
  CHECK(told(judged(corrected, errors)).empty());
  corrected.is_reference = true;
  CHECK(told(judged(corrected, errors)) ==
        "the healthy reference of its signal: its leak is zero by construction\n");
  CHECK_FALSE(judged(corrected, errors).leak.class_);
  CHECK_FALSE(judged(corrected, errors).leak.leak_share_percent);
  CHECK_FALSE(judged(corrected, errors).explained_by_leak);
}
