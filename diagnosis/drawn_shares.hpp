#pragma once

#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/posterior.hpp"
#include "calib/search/budget.hpp"

namespace rigcal::diagnosis {

/// Computes the leak share for every free leakage coefficient of a fit, and how probable each class
/// is, over draws from the posterior. A share is that of steady_leak() for the duty, which is the
/// same for all leak levels: the duty of the campaign if it was fitted, otherwise as duty_among()
/// chooses one. The other parameters of a draw count, too. A draw that cannot be simulated is left
/// out; a coefficient without any draw is, too.
///
/// @param draws  shape (draws, unknowns), unit-box coordinates
/// @param left   if it is interrupted, the result is empty
std::vector<calib::DrawnShare> drawn_shares(const calib::Problem& problem,
                                            const std::vector<std::vector<double>>& draws,
                                            int threads, const calib::Budget& left);

}  // namespace rigcal::diagnosis
