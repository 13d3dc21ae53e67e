#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/figure/response_plot.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// The figures that show, for one channel of a condition, how well the model agrees with the
/// record: parity, histogram of the residual and, if the signals allow it, gain and phase over
/// frequency.
struct ChannelAgreement {
  std::string channel;
  std::vector<Figure> figures;
  std::string residual;  ///< mean and standard deviation of the residual, in words
  std::string response;  ///< input used for gain and phase, or why there are none
};

/// @param condition     id of the condition
/// @param frequency_hz  frequency of a periodic drive; absent for other drives
/// @param series        contents of residuals/<condition>.csv
std::vector<ChannelAgreement> channel_agreements(const std::string& condition,
                                                 std::optional<double> frequency_hz,
                                                 const Table& series);

/// Returns gain and phase of a channel; std::nullopt if the signals do not allow it.
///
/// @param channel  its key in the results
std::optional<ResponseCurves> channel_response(const std::string& channel,
                                               std::optional<double> frequency_hz,
                                               const Table& series);

/// Returns the figures of every channel with explanations.
doc::Blocks agreement_blocks(const std::string& condition, std::optional<double> frequency_hz,
                             const Table& series);

}  // namespace rigcal::report
