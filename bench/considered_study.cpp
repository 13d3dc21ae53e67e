// How often 95 % intervals hold the truth where the rig has a small effect that the fitted model
// lacks, and how often a plain PASS stands beside an interval that misses it by more than three
// half widths (false assurance). The records are those of bench/foreign_rig.hpp, which shares no
// line with the product. Prints the second table of docs/uncertainty.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/foreign_campaign.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "common/significant.hpp"
#include "datasets/prepare/load_record.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;

constexpr double kNoise_m = 0.05e-3;
constexpr double kOff = 1.1;
const std::vector<Reference> kFitted{
    {"square", 1.0, 0.05, 2.0}, {"square", 4.0, 0.02, 1.0}, {"sine", 5.0, 0.02, 1.0}};
const Reference kValidated{"sine", 2.0, 0.05, 1.0};

/// An effect with the size that the catalogue gives it on this rig.
struct ForeignEffect {
  const char* name;
  double plausible;
  bool one_sided;
  void (*apply)(ForeignRig&, double size);
};

const std::vector<ForeignEffect> kEffects{
    {"valve_time_constant", 0.5e-3, true, [](ForeignRig& r, double s) { r.valve_lag_s = s; }},
    {"transport_delay", 0.5e-3, true, [](ForeignRig& r, double s) { r.delay_s = s; }},
    {"valve_offset", 3e-3, false, [](ForeignRig& r, double s) { r.null_shift_v = s; }},
    {"valve_dead_band", 0.01, true, [](ForeignRig& r, double s) { r.dead_band_v = s; }},
    {"coulomb_friction", 10.0, true, [](ForeignRig& r, double s) { r.friction_n = s; }},
    {"laminar_leakage", 3.9e-12, true, [](ForeignRig& r, double s) { r.laminar_m3_per_s_pa = s; }},
    {"ki", 0.6, true, [](ForeignRig& r, double s) { r.integral_v_per_m_s = s; }},
    {"total_volume", 2.47e-6, true, [](ForeignRig& r, double s) { r.hose_volume_m3 = s; }},
    {"supply_sag", 0.01, true, [](ForeignRig& r, double s) { r.sag = s; }},
    {"position_lag", 0.32e-3, true, [](ForeignRig& r, double s) { r.sensor_lag_s = s; }},
    {"position_gain", 2e-3, false, [](ForeignRig& r, double s) { r.sensor_gain = s; }},
    {"position_offset", 0.03e-3, false, [](ForeignRig& r, double s) { r.sensor_offset_m = s; }},
    {"position_bow", 0.152e-3, false, [](ForeignRig& r, double s) { r.sensor_bow_m = s; }},
    {"position_wave", 0.152e-3, false, [](ForeignRig& r, double s) { r.sensor_wave_m = s; }},
    {"position_hysteresis", 0.03e-3, true,
     [](ForeignRig& r, double s) { r.sensor_hysteresis_m = s; }}};

struct Row {
  std::string name;
  std::string effect;  ///< which is to be named; empty: none, or several
  std::function<void(ForeignRig&, boost::random::mt19937_64&)> apply;
  bool drawn = false;  ///< anew for each campaign
};

std::vector<Row> rows() {
  std::vector<Row> all;
  all.push_back({"none", "", [](ForeignRig&, auto&) {}, false});
  all.push_back({"all, drawn from their sizes", "",
                 [](ForeignRig& rig, auto& stream) {
                   boost::random::normal_distribution<double> normal;
                   for (const ForeignEffect& each : kEffects) {
                     const double size = each.plausible * normal(stream);
                     each.apply(rig, each.one_sided ? std::abs(size) : size);
                   }
                 },
                 true});
  for (const ForeignEffect& each : kEffects) {
    for (const double factor : {0.3, 1.0, 3.0}) {
      all.push_back(
          {fmt::format("{} of {} times its size", each.name, factor), each.name,
           [each, factor](ForeignRig& rig, auto&) { each.apply(rig, factor * each.plausible); },
           false});
    }
  }
  const auto known = [&](const char* name, const char* effect, void (*apply)(ForeignRig&)) {
    all.push_back({name, effect, [apply](ForeignRig& rig, auto&) { apply(rig); }, false});
  };
  known("omission: valve lag of 0.2 ms", "valve_time_constant",
        [](ForeignRig& r) { r.valve_lag_s = 0.2e-3; });
  known("omission: valve lag of 0.3 ms", "valve_time_constant",
        [](ForeignRig& r) { r.valve_lag_s = 0.3e-3; });
  known("omission: friction of 3 N", "coulomb_friction", [](ForeignRig& r) { r.friction_n = 3.0; });
  known("omission: friction of 10 N", "coulomb_friction",
        [](ForeignRig& r) { r.friction_n = 10.0; });
  known("omission: dead band of 0.05 %", "valve_dead_band",
        [](ForeignRig& r) { r.dead_band_v = 0.005; });
  known("omission: dead band of 0.1 %", "valve_dead_band",
        [](ForeignRig& r) { r.dead_band_v = 0.01; });
  known("omission: laminar leak of 5e-12", "laminar_leakage",
        [](ForeignRig& r) { r.laminar_m3_per_s_pa = 5e-12; });
  known("omission: delay of 0.5 ms", "transport_delay", [](ForeignRig& r) { r.delay_s = 0.5e-3; });
  known("omission: null shift of 0.2 %", "valve_offset",
        [](ForeignRig& r) { r.null_shift_v = 0.02; });
  known("omission: nonlinearity of 0.05 %", "position_wave",
        [](ForeignRig& r) { r.sensor_wave_m = 0.06e-3; });
  known("omission: nonlinearity of 0.1 %", "position_wave",
        [](ForeignRig& r) { r.sensor_wave_m = 0.12e-3; });
  known("omission: integral gain of 5 V/(m s)", "ki",
        [](ForeignRig& r) { r.integral_v_per_m_s = 5.0; });
  return all;
}

struct Estimate {
  const char* key;
  double truth;
};
const std::vector<Estimate> kEstimates{{"mass", 110.0},
                                       {"damping", 1400.0},
                                       {"bulk_modulus", 800e6},
                                       {"valve_gain", 4.5e-5},
                                       {"leakage_coefficient", 0.35}};

int row_of(const std::string& key) {
  return model::parameter_index(model::PlantKind::load_pressure, key);
}

datasets::Condition condition_of(const Reference& reference, datasets::Use use) {
  datasets::Condition condition;
  condition.id = fmt::format("{}_{}Hz", reference.waveform, reference.frequency_hz);
  condition.waveform =
      reference.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
  condition.frequency_hz = reference.frequency_hz;
  condition.amplitude = reference.amplitude_m;
  condition.duration_s = reference.duration_s;
  condition.use = use;
  return condition;
}

/// The campaign of its user: exact but for what the rig's effects add.
datasets::Campaign campaign_of(const ForeignRig& rig) {
  datasets::Campaign campaign = foreign_campaign(rig);
  for (const Estimate& each : kEstimates) {
    datasets::ParameterSetting setting;
    setting.index = row_of(each.key);
    setting.fit = true;
    setting.value = kOff * each.truth;
    setting.lower = each.truth / 5.0;
    setting.upper = each.truth * 5.0;
    campaign.parameters.push_back(setting);
  }
  for (const Reference& each : kFitted)
    campaign.conditions.push_back(condition_of(each, datasets::Use::fit));
  campaign.conditions.push_back(condition_of(kValidated, datasets::Use::validate));
  campaign.acceptance = {{Channel::position, "rho2", 0.99, 0.995},
                         {Channel::position, "ccc", 0.99, std::nullopt},
                         {Channel::position, "absolute_error_percent", 1.0, std::nullopt}};
  return campaign;
}

datasets::Record record_of(const datasets::Campaign& campaign, const datasets::Condition& condition,
                           const std::vector<double>& readings, int repeats,
                           boost::random::mt19937_64& stream) {
  boost::random::normal_distribution<double> normal(0.0, kNoise_m);
  std::vector<datasets::Repeat> all;
  for (int r = 0; r < repeats; ++r) {
    datasets::Repeat& repeat = all.emplace_back();
    repeat.source = fmt::format("repeat {}", r + 1);
    std::vector<double>& x = repeat.values[Channel::position];
    for (std::size_t k = 0; k < readings.size(); ++k) {
      repeat.time_s.push_back(static_cast<double>(k) / 1000.0);
      x.push_back(readings[k] + normal(stream));
    }
  }
  return datasets::average_of(campaign, condition, all, true);
}

/// One entry per condition, in the order of the campaign.
std::vector<std::vector<double>> readings_of_all(const ForeignRig& rig) {
  std::vector<std::vector<double>> all;
  for (const Reference& reference : kFitted) all.push_back(foreign_readings(rig, reference));
  all.push_back(foreign_readings(rig, kValidated));
  return all;
}

struct StudyOutcome {
  bool converged = false;
  std::vector<bool> holds, exact;
  std::vector<double> half_width, error;  ///< over the truth
  double worst = 0.0;                     ///< miss over half width
  calib::Verdict verdict = calib::Verdict::fail;
  std::string named;  ///< the effect that the residuals ask for first
};

StudyOutcome outcome_of(const calib::Fit& fit) {
  StudyOutcome result;
  result.converged = fit.status == calib::FitStatus::converged;
  if (!result.converged) return result;
  for (const Estimate& each : kEstimates) {
    const auto found =
        std::find_if(fit.parameters.begin(), fit.parameters.end(),
                     [&](const auto& parameter) { return parameter.index == row_of(each.key); });
    const auto [low, high] = found->ci95.value();
    const auto exact = found->ci95_if_exact.value();
    result.holds.push_back(low <= each.truth && each.truth <= high);
    result.exact.push_back(exact.first <= each.truth && each.truth <= exact.second);
    const double half = (high - low) / 2.0;
    result.half_width.push_back(half / each.truth);
    result.error.push_back((found->value - each.truth) / each.truth);
    const double outside = std::max({low - each.truth, each.truth - high, 0.0});
    result.worst = std::max(result.worst, outside > 0.0 ? outside / half + 1.0 : 0.0);
  }
  result.verdict = fit.verdict.value();
  if (fit.considered && !fit.considered->missing.empty())
    result.named = fit.considered->effects[fit.considered->missing.front()].key;
  return result;
}

std::string percent(std::size_t count, std::size_t of) {
  return fmt::format("{:.1f}", 100.0 * static_cast<double>(count) / static_cast<double>(of));
}

template <typename Each>
std::string of_each(const Each& text) {
  std::vector<std::string> words;
  for (std::size_t j = 0; j < kEstimates.size(); ++j) words.push_back(text(j));
  return fmt::format("{}", fmt::join(words, " "));
}

void study_row(const Row& row, std::size_t asked, int repeats, int threads) {
  std::vector<StudyOutcome> outcomes(asked);
  std::vector<std::vector<double>> same_readings;
  if (!row.drawn) {
    boost::random::mt19937_64 unused;
    ForeignRig rig;
    row.apply(rig, unused);
    same_readings = readings_of_all(rig);
  }
  parallel_for(asked, threads, [&](std::size_t i) {
    boost::random::mt19937_64 stream(i + 1);
    ForeignRig rig;
    row.apply(rig, stream);
    const auto readings = row.drawn ? readings_of_all(rig) : same_readings;
    const datasets::Campaign campaign = campaign_of(rig);
    std::vector<datasets::Record> records;
    for (std::size_t c = 0; c < campaign.conditions.size(); ++c)
      records.push_back(record_of(campaign, campaign.conditions[c], readings[c], repeats, stream));
    outcomes[i] = outcome_of(calib::fit(campaign, records, {}));
  });
  std::erase_if(outcomes, [](const StudyOutcome& each) { return !each.converged; });
  const std::size_t campaigns = outcomes.size();
  if (campaigns == 0) throw std::runtime_error("no fit of this row has converged");
  const auto count = [&](const auto& holds) {
    return static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(), holds));
  };
  const auto covered = [&](std::vector<bool> StudyOutcome::*member) {
    return of_each([&](std::size_t j) {
      return percent(count([&](const StudyOutcome& each) { return bool((each.*member)[j]); }),
                     campaigns);
    });
  };
  const auto median = [&](std::size_t j) {
    std::vector<double> widths;
    for (const StudyOutcome& each : outcomes) widths.push_back(each.half_width[j]);
    std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(campaigns / 2),
                     widths.end());
    return widths[campaigns / 2];
  };
  const auto rms = [&](std::size_t j) {
    double sum = 0.0;
    for (const StudyOutcome& each : outcomes) sum += each.error[j] * each.error[j];
    return std::sqrt(sum / static_cast<double>(campaigns));
  };
  const auto verdicts = fmt::format(
      "{}/{}/{}{}", count([](const StudyOutcome& o) { return o.verdict == calib::Verdict::pass; }),
      count([](const StudyOutcome& o) { return o.verdict == calib::Verdict::warn; }),
      count([](const StudyOutcome& o) { return o.verdict == calib::Verdict::fail; }),
      campaigns == asked ? "" : fmt::format(", {} not converged", asked - campaigns));
  const std::size_t falsely = count(
      [](const StudyOutcome& o) { return o.verdict == calib::Verdict::pass && o.worst > 3.0; });
  const std::size_t named =
      count([&](const StudyOutcome& o) { return !o.named.empty() && o.named == row.effect; });
  std::map<std::string, int> others;
  for (const StudyOutcome& each : outcomes)
    if (!each.named.empty() && each.named != row.effect) ++others[each.named];
  std::string other;
  for (const auto& [name, times] : others) other += fmt::format(" {} {}", name, times);
  std::cout << fmt::format(
                   "| {} | {} | {} | {} | {} | {} | {} | {}{} |\n", row.name,
                   covered(&StudyOutcome::holds), covered(&StudyOutcome::exact),
                   of_each([&](std::size_t j) { return significant(100.0 * median(j), 2); }),
                   of_each([&](std::size_t j) { return significant(median(j) / rms(j), 2); }),
                   verdicts, percent(falsely, campaigns), percent(named, campaigns),
                   other.empty() ? "" : ";" + other)
            << std::flush;
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 200;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const std::string only = argc > 3 ? argv[3] : "";
  const int repeats = argc > 4 ? std::atoi(argv[4]) : 5;
  if (campaigns < 1 || threads < 1 || repeats < 2 || argc > 5) {
    std::cerr << "usage: rigcal_considered_study [campaigns] [threads] [part of a row's name] "
                 "[repeats]\n";
    return 2;
  }
  std::cout << fmt::format(
      "| {} campaigns each, {} repeats | holds the truth, % (mass, damping, bulk_modulus, "
      "valve_gain, leakage_coefficient) | `ci95_if_exact`, % | median half width, % | over the rms "
      "error | PASS/WARN/FAIL | false assurance, % | named first, %; others |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      campaigns, repeats);
  for (const auto& row : rigcal::bench::rows()) {
    if (row.name.find(only) == std::string::npos) continue;
    rigcal::bench::study_row(row, static_cast<std::size_t>(campaigns), repeats, threads);
  }
  return 0;
}
