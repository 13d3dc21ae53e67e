#pragma once

namespace rigcal::datasets {

/// Accepted range of a quantity in a campaign file, in SI. Excludes values that no rig has, and
/// sizes that would lead to endless loops or excessive allocations.
struct QuantityRange {
  double lower = 0.0;
  double upper = 0.0;
};

/// Frequencies of a drive or ripple. Above the upper limit, the time between two edges of a square
/// wave would be below the time resolution.
inline constexpr QuantityRange kFrequencies_hz{1e-6, 1e5};
/// Frequencies including zero, for the start of a linear chirp.
inline constexpr QuantityRange kFrequenciesFromZero_hz{0.0, 1e5};
inline constexpr QuantityRange kSampleRates_hz{1e-6, 1e8};
/// Durations from a microsecond to 30 years.
inline constexpr QuantityRange kDurations_s{1e-6, 1e9};
/// Time stamps, which may count from 1970.
inline constexpr QuantityRange kInstants_s{-1e10, 1e10};
inline constexpr QuantityRange kJitters_s{0.0, 1e3};
/// Amplitudes of a drive in m or V.
inline constexpr QuantityRange kAmplitudes{1e-9, 1e6};
inline constexpr QuantityRange kLoadAmplitudes{1e-6, 1e9};  ///< forces and pressures
inline constexpr QuantityRange kFlows_m3_per_s{1e-15, 1e3};
inline constexpr QuantityRange kTemperatures_k{0.0, 1e4};
/// Standard deviations, steps and ripples in the unit of a channel; zero means no disturbance.
inline constexpr QuantityRange kDisturbances{0.0, 1e12};
/// Standard deviations that residuals are divided by, hence not zero.
inline constexpr QuantityRange kStandardDeviations{1e-15, 1e12};
/// Standard deviations of a parameter; values for a laminar leak are small in SI.
inline constexpr QuantityRange kParameterDeviations{1e-25, 1e12};
/// Magnitudes of factors and of offsets in a channel's unit.
inline constexpr QuantityRange kSizes{1e-15, 1e15};

/// Maximum number of samples for a condition without a record, similar to the limit for files.
inline constexpr double kMostSamples = 1e7;

}  // namespace rigcal::datasets
