#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/design/design.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"

// `design` of plan.json (docs/plan-design.md).

namespace rigcal::report {

// Files of a design beside plan.json.
inline constexpr const char* kDriveFile = "design.csv";
inline constexpr const char* kResponseFile = "design_response.csv";
inline constexpr const char* kDesignedCampaignFile = "design.toml";

struct StoredDesignLimit {
  std::string key, words, unit;
  double limit = 0.0;
  double reached = 0.0;
  double share_percent = 0.0;  ///< used part; at most 100
  RIGCAL_DESCRIBE(key, words, unit, limit, reached, share_percent)
};

struct StoredDesign {
  std::string status;  ///< "done", or "stopped": the best drive until a signal
  datasets::DriveFamily family = datasets::DriveFamily::multisine;
  datasets::DesignCriterion criterion = datasets::DesignCriterion::determinant;
  std::string channel;  ///< channel of the drive, as in the campaign file
  std::string unit;     ///< SI unit of the drive
  double amplitude = 0.0;
  double duration_s = 0.0;
  double sample_rate_hz = 0.0;
  int repeats = 0;
  std::uint64_t seed = 0;
  std::optional<std::string> leak_level;
  Keyed<double> noise_sd;  ///< per sample of one repeat, by channel with its SI unit
  std::vector<calib::DesignedParameter> parameters;
  std::vector<StoredDesignLimit> limits;
  std::vector<calib::DrivePart> drive;
  std::vector<calib::FamilyTrial> families;
  std::vector<std::string> own_signals;  ///< conditions that are compared with
  double own_signals_duration_s = 0.0;   ///< all of them together
  std::vector<std::string> messages;
  RIGCAL_DESCRIBE(status, family, criterion, channel, unit, amplitude, duration_s, sample_rate_hz,
                  repeats, seed, leak_level, noise_sd, parameters, limits, drive, families,
                  own_signals, own_signals_duration_s, messages)

  bool stopped() const { return status == "stopped"; }
};

}  // namespace rigcal::report
