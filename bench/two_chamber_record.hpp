#pragma once

namespace rigcal::bench {

/// Prints the cost of a record of 20 s at 10 kHz with sensitivities to ten parameters of a cylinder
/// with both chambers and a first-order valve: CPU times, as medians.
void two_chamber_record(int rounds);

}  // namespace rigcal::bench
