#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/page/page_parts.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// The figures of one channel of a condition that show the agreement of model and record: parity,
/// histogram of the residual and, if the signals allow it, gain and phase over frequency.
struct ChannelAgreement {
  std::string channel;
  std::vector<Figure> figures;
  std::string residual;  ///< mean and standard deviation of the residual in words
  std::string response;  ///< input of gain and phase, or why there are none
};

/// @param condition     its id
/// @param frequency_hz  of a periodic drive; else nothing
/// @param series        residuals/<condition>.csv
std::vector<ChannelAgreement> channel_agreements(const std::string& condition,
                                                 std::optional<double> frequency_hz,
                                                 const Table& series);

/// Frequency of a condition's drive where it is periodic, from its entry in fit.json.
std::optional<double> periodic_frequency(const StoredCondition& condition);

/// The figures of every channel with explanations.
doc::Blocks agreement_blocks(const std::string& condition, std::optional<double> frequency_hz,
                             const Table& series);

}  // namespace rigcal::report
