#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/diagnose.hpp"

// Diagnoses laminar leaks in records of another simulator (shared/data/sim_hopsan_leaky_servo), to
// which noise is added. bench/leak_law_study.cpp measures the rates over many seeds.

using namespace rigcal;
using datasets::Campaign;
using datasets::Channel;

namespace {

const std::string kHopsanRecords = std::string(RIGCAL_RECORDINGS_DIR) + "/sim_hopsan_leaky_servo";
const std::string kRig = RIGCAL_SOURCE_DIR "/datasets/rigs/hopsan_leaky_servo/";
constexpr int kHopsanRepeats = 3;

/// The rig with its known values. Position and both pressures are recorded.
Campaign known_rig() {
  Campaign campaign = datasets::load_campaign(kRig + "two_chamber.toml", kHopsanRecords);
  campaign.channels =
      datasets::load_campaign(kRig + "two_chamber_fit.toml", kHopsanRecords).channels;
  campaign.simulation.tolerance.reset();
  campaign.diagnosis.leak_law = datasets::LeakLaw::laminar;
  campaign.diagnosis.level_class["none"] = datasets::LeakClass::normal;
  return campaign;
}

std::vector<datasets::Repeat> with_noise(const datasets::Repeat& clean,
                                         boost::random::mt19937_64& stream) {
  boost::random::normal_distribution<double> normal;
  std::vector<datasets::Repeat> repeats(kHopsanRepeats, clean);
  for (datasets::Repeat& repeat : repeats) {
    for (auto& [channel, values] : repeat.values) {
      const double sd = channel == Channel::position ? 0.05e-3 : 1e4;
      for (double& value : values) value += sd * normal(stream);
    }
  }
  return repeats;
}

}  // namespace

TEST_CASE("diagnose: small laminar leaks of another simulator are told from none", "[diagnosis]") {
  if (!std::filesystem::exists(kHopsanRecords)) {
    WARN("skipped: no records in " + kHopsanRecords);
    return;
  }
  struct Case {
    std::string source, level;
    double conductance;
  };
  const std::string none = "square_10hz_noleak_kp79_w2000_vd0";
  const std::vector<Case> cases{{none, "none", 0.0},
                                {none, "again", 0.0},
                                {"square_10hz_lam1em12_kp79_w2000_vd0", "small", 1e-12},
                                {"square_10hz_lam2em11_kp79_w2000_vd0", "large", 2e-11}};
  const Campaign all = known_rig();
  Campaign campaign = all;
  campaign.conditions.clear();
  std::vector<datasets::RepeatRecords> records;
  boost::random::mt19937_64 stream(1);
  for (const Case& each : cases) {
    datasets::Condition condition = *all.find(each.source);
    const auto repeats = with_noise(datasets::load_all_repeats(all, condition).front(), stream);
    condition.id = each.level;
    condition.leak_level = each.level;
    condition.date = "2026-03-02";
    condition.use = datasets::Use::diagnose;
    campaign.conditions.push_back(condition);
    records.push_back(datasets::repeat_records(campaign, condition, repeats));
  }
  const diagnosis::Diagnosis found = diagnosis::diagnose(campaign, records, {}, {});
  for (const auto& record : found.records) {
    if (record.repeat || record.is_reference) continue;
    CAPTURE(record.condition, record.fit.failure, record.fit.coefficient);
    REQUIRE(record.fit.ok());
    const double truth = std::find_if(cases.begin(), cases.end(), [&](const Case& each) {
                           return each.level == record.condition;
                         })->conductance;
    CHECK(record.estimate.leak_detected == (truth > 0.0));
    // Five standard errors: the noise is of one seed.
    CHECK(std::abs(record.fit.coefficient - truth) < 5.0 * record.estimate.standard_error);
  }
}
