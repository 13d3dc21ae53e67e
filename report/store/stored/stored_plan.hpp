#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/stored/stored_design.hpp"
#include "report/store/stored/stored_provenance.hpp"

// plan.json (docs/command-line.md).

namespace rigcal::report {

inline constexpr const char* kPlanSchema = "rigcal.plan/1";

struct StoredPlannedParameter {
  std::string name, unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;
  bool nuisance = false;
  std::optional<double> value;
  std::optional<double> sd_recorded, sd_all;  ///< nothing: not determined
  std::optional<std::string> remedy;
  RIGCAL_DESCRIBE(name, unit, scope, level, nuisance, value, sd_recorded, sd_all, remedy)

  std::string label() const;  ///< "leakage_coefficient (33 %)"
};

struct StoredPlannedRecord {
  std::string condition;
  bool recorded = false;
  std::optional<std::string> problem;
  std::vector<std::optional<double>> sd_alone;    ///< for each parameter, if anything is known
  std::vector<std::optional<double>> sd_without;  ///< likewise, from all other records
  RIGCAL_DESCRIBE(condition, recorded, problem, sd_alone, sd_without)
};

struct StoredPlan {
  std::string schema = kPlanSchema;
  std::string campaign;
  std::vector<StoredPlannedParameter> parameters;
  std::vector<StoredPlannedRecord> records;
  std::vector<std::string> messages;
  Omittable<StoredDesign> design;  ///< result of `plan --design`
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(schema, campaign, parameters, records, messages, design, provenance)
};

}  // namespace rigcal::report
