#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/prepare/repeatability.hpp"
#include "datasets/record.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/stored/stored_provenance.hpp"

// A record in the output of `check` and `average`, and in average.json.

namespace rigcal::report {

inline constexpr const char* kAverageSchema = "rigcal.average/1";

struct StoredRecord {
  std::string condition;
  datasets::Use use = datasets::Use::fit;
  long samples = 0;
  std::optional<double> sample_rate_hz, duration_s;
  int repeats = 1;
  std::vector<std::string> files;
  Keyed<datasets::Repeatability> channels;
  std::optional<double> offset_range_s;
  std::vector<datasets::RepeatReport> repeat_reports;
  std::vector<Range> windows_s;  ///< intervals that count; empty: the whole record
  std::vector<std::string> notes, warnings;
  RIGCAL_DESCRIBE(condition, use, samples, sample_rate_hz, duration_s, repeats, files, channels,
                  offset_range_s, repeat_reports, windows_s, notes, warnings)

  long outliers() const;
};

/// Agreement of the repeats in every condition.
struct StoredAverage {
  std::string schema = kAverageSchema;
  std::string campaign;
  bool synthetic = false;
  std::vector<StoredRecord> records;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(schema, campaign, synthetic, records, provenance)
};

StoredRecord stored(const datasets::Condition& condition, const datasets::Record& record);

}  // namespace rigcal::report
