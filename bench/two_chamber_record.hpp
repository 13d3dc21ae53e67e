#pragma once

namespace rigcal::bench {

/// Prints median CPU times for a record of 20 s at 10 kHz, with sensitivities to ten parameters of
/// a two-chamber cylinder with a first-order valve.
void two_chamber_record(int rounds);

}  // namespace rigcal::bench
