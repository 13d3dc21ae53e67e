#pragma once

#include <string>
#include <string_view>

#include "metrics/residual_tests.hpp"

// Results of residual tests in words.

namespace rigcal::report {

std::string autocorrelation_words(const metrics::ResidualTests& tests);
std::string cross_correlation_words(const metrics::CrossCorrelation& test);
std::string periodogram_words(const metrics::Periodogram& test);
std::string normality_words(const metrics::Normality& test);
/// @param unit  of the residual, SI
std::string drift_words(const metrics::ResidualTests& tests, std::string_view unit);

}  // namespace rigcal::report
