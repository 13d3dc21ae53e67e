#pragma once

namespace rigcal::bench {

/// Prints what a record of 20 s at 10 kHz costs with sensitivities to ten parameters of a cylinder
/// with both chambers, its valve of first order: CPU time, medians.
void two_chamber_record(int rounds);

}  // namespace rigcal::bench
