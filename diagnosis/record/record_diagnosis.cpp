#include "diagnosis/record/record_diagnosis.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/readable.hpp"
#include "common/significant.hpp"

namespace rigcal::diagnosis {
namespace {

/// The share is on a plateau if its relative change is below this fraction of the relative change
/// in the coefficient.
constexpr double kFlat = 0.1;
/// Limits for the fraction of the difference from the healthy model that a leak leaves unexplained.
/// Above kNoticeable it is reported, and above kTooMuch no class is assigned.
constexpr double kNoticeable = 0.05;
constexpr double kTooMuch = 1.0 / 3.0;

void warn(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
          datasets::LeakLaw law) {
  const LeakFit& fit = record.fit;
  const LeakEstimate& estimate = record.estimate;
  const double left = unexplained_share(fit, healthy_m);
  const bool explained = record.explained_by_leak.value();
  if (explained && left > kNoticeable) {
    record.warnings.push_back(fmt::format(
        "a leak explains all but {:.0f} % of the difference from the healthy model (rms {}"
        "); the remaining {} exceed the noise: there may be another fault",
        100.0 * left, readable(fit.parity_rms_m, "m", 3), readable(fit.misfit_rms_m, "m", 3)));
  }
  if (!explained) {
    record.warnings.push_back(fmt::format(
        "not explained by a leak, which reduces the difference from the healthy model only from "
        "{} to {} rms; in healthy records it is {}. Something else is wrong "
        "(friction, valve, sensor), or the fit does not apply to this record",
        readable(fit.parity_rms_m, "m", 3), readable(fit.misfit_rms_m, "m", 3),
        readable(healthy_m, "m", 3)));
  }
  if (estimate.incompatible) {
    record.warnings.push_back(
        fmt::format("incompatible with the model: the coefficient would be {} ({} to "
                    "{}), below zero by more than its error: the machine is faster than its "
                    "healthy model, so supply or valve have changed since the fit",
                    significant(fit.coefficient, 3), significant(estimate.ci95.low, 3),
                    significant(estimate.ci95.high, 3)));
  }
  if (!estimate.has_share()) {
    record.warnings.push_back(
        fmt::format("a coefficient of {:.3g} would leak more than the servo valve delivers, so "
                    "share and class are undefined",
                    fit.coefficient));
  }
  const double log_slope =
      estimate.share > 0.0 ? estimate.share_slope * fit.coefficient / estimate.share : 1.0;
  if (std::abs(log_slope) < kFlat) {
    record.warnings.push_back(
        fmt::format("the share hardly depends on the coefficient here (d ln share / d ln C = "
                    "{:.2g}): for this signal a coefficient cannot be inferred from a share",
                    log_slope));
  }
  if (!errors.repeat_m)
    record.warnings.emplace_back(
        "no repeats of this signal: the interval does not include the variation from run to run");
  if (!errors.healthy_m && record.reference_repeats == 0)
    record.warnings.push_back(fmt::format(
        "no healthy record of this signal: the interval does not include model error. If a leak "
        "level is healthy, state it: --healthy LEVEL, or level_class = {{ \"LEVEL\" = \"normal\" "
        "}} in [diagnosis], or parameters = {{ {} = 0 }} in [leak_level.\"LEVEL\"]",
        datasets::leak_parameter(law)));
}

}  // namespace

void judge(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
           const datasets::DiagnosisSettings& settings) {
  if (record.is_reference) {
    record.warnings.emplace_back(
        "the healthy reference of its signal: its leak is zero by construction");
    return;
  }
  const LeakEstimate& estimate = record.estimate;
  record.explained_by_leak = !(unexplained_share(record.fit, healthy_m) > kTooMuch);
  record.leak = stated(estimate, settings.least_probability);
  if (!*record.explained_by_leak) record.leak.class_.reset();
  record.unbounded_leakage_coefficient = estimate.coefficient;
  if (estimate.has_class() && estimate.share > 0.0)
    record.log_slope = estimate.share_slope * estimate.coefficient / estimate.share;
  warn(record, errors, healthy_m, settings.leak_law);
}

}  // namespace rigcal::diagnosis
