#pragma once

#include <string>

#include "diagnosis/leak_trend.hpp"

namespace rigcal::report {

/// Describes the trend in a sentence for an operator: "66.66 %: the leak rises by 1.2 percentage
/// points of the servo flow in 30 days ...".
std::string trend_sentence(const diagnosis::LeakTrend& trend);

}  // namespace rigcal::report
