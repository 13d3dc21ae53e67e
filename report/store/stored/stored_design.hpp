#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"

// `design` of plan.json (docs/plan-design.md).

namespace rigcal::report {

// Files of a design beside plan.json.
inline constexpr const char* kDriveFile = "design.csv";
inline constexpr const char* kResponseFile = "design_response.csv";
inline constexpr const char* kDesignedCampaignFile = "design.toml";

struct StoredDesignedParameter {
  std::string name, unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;
  bool named = false;  ///< the drive was designed for it
  double value = 0.0;
  std::optional<double> sd;              ///< nothing: the test does not determine it
  std::optional<double> sd_own_signals;  ///< from the campaign's signals in the same time
  RIGCAL_DESCRIBE(name, unit, scope, level, named, value, sd, sd_own_signals)

  std::string label() const;  ///< "leakage_coefficient (33 %)"
};

struct StoredDesignLimit {
  std::string key, words, unit;
  double limit = 0.0;
  double reached = 0.0;
  double share_percent = 0.0;  ///< used part; at most 100
  RIGCAL_DESCRIBE(key, words, unit, limit, reached, share_percent)
};

struct StoredDrivePart {
  std::string name, unit;
  double value = 0.0;
  RIGCAL_DESCRIBE(name, unit, value)
};

struct StoredFamilyTrial {
  datasets::DriveFamily family = datasets::DriveFamily::multisine;
  int evaluations = 0;
  bool found = false;                     ///< one of them keeps the limits
  std::vector<std::optional<double>> sd;  ///< for each parameter, by the best drive
  RIGCAL_DESCRIBE(family, evaluations, found, sd)
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
  std::vector<StoredDesignedParameter> parameters;
  std::vector<StoredDesignLimit> limits;
  std::vector<StoredDrivePart> drive;
  std::vector<StoredFamilyTrial> families;
  std::vector<std::string> own_signals;  ///< conditions that are compared with
  double own_signals_duration_s = 0.0;   ///< all of them together
  std::vector<std::string> messages;
  RIGCAL_DESCRIBE(status, family, criterion, channel, unit, amplitude, duration_s, sample_rate_hz,
                  repeats, seed, leak_level, noise_sd, parameters, limits, drive, families,
                  own_signals, own_signals_duration_s, messages)

  bool stopped() const { return status == "stopped"; }
};

}  // namespace rigcal::report
