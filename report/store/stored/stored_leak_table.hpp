#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/table/leak_table.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/stored/stored_provenance.hpp"

// leak_table.json (docs/command-line.md).

namespace rigcal::report {

inline constexpr const char* kLeakTableSchema = "rigcal.leak_table/1";

struct StoredLeakTable : diagnosis::LeakTable {
  std::string status = "done";
  std::string schema = kLeakTableSchema;
  std::string campaign;
  std::string share = "mean |Q_leak| / mean |Q_servo| over one period, periodic";
  std::string residual = "|position without leak - position with leak| times residual_scale";
  std::string interval =
      "95 % interval of each coefficient from the covariance of the fit, to first order in the "
      "fit's values: "
      "ln C moves by -(d ln s / dp) / (d ln s / d ln C); null without a fit";
  Omittable<std::vector<std::string>> notes;
  Omittable<std::vector<std::string>> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, campaign, share, residual, interval, notes, warnings, assumptions,
                  fixed_combinations, entries, summary, normal, features, provenance)
};

}  // namespace rigcal::report
