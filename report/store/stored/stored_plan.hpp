#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/design/design.hpp"
#include "calib/trust/plan.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/stored/stored_provenance.hpp"

// plan.json (docs/command-line.md), with its `design` (docs/plan-design.md).

namespace rigcal::report {

inline constexpr const char* kPlanSchema = "rigcal.plan/1";

// Files of a design, next to plan.json.
inline constexpr const char* kDriveFile = "design.csv";
inline constexpr const char* kResponseFile = "design_response.csv";
inline constexpr const char* kDesignedCampaignFile = "design.toml";

struct StoredDesignLimit {
  std::string key, words, unit;
  double limit = 0.0;
  double reached = 0.0;
  double share_percent = 0.0;  ///< used fraction of the limit; at most 100
  RIGCAL_DESCRIBE(key, words, unit, limit, reached, share_percent)
};

struct StoredDesign : calib::DesignedTest {
  std::string status;  ///< "done", or "stopped" by a signal with the best drive so far
  datasets::DesignCriterion criterion = datasets::DesignCriterion::determinant;
  std::string channel;  ///< channel of the drive, as in the campaign file
  std::string unit;     ///< SI unit of the drive
  double duration_s = 0.0;
  double sample_rate_hz = 0.0;
  int repeats = 0;
  std::uint64_t seed = 0;
  std::optional<std::string> leak_level;
  Keyed<double> noise_sd;  ///< per sample of one repeat, by channel with its SI unit
  std::vector<StoredDesignLimit> limits;
  RIGCAL_DESCRIBE(status, family, criterion, channel, unit, amplitude, duration_s, sample_rate_hz,
                  repeats, seed, leak_level, noise_sd, parameters, limits, drive, families,
                  own_signals, own_signals_duration_s, messages)

  bool stopped() const { return status == "stopped"; }
};

struct StoredPlan : calib::Plan {
  std::string schema = kPlanSchema;
  std::string campaign;
  Omittable<StoredDesign> design;  ///< result of `plan --design`
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(schema, campaign, parameters, records, messages, design, provenance)
};

}  // namespace rigcal::report
