#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"

/// The problems with which speed is measured. They need no files.
namespace rigcal::bench {

struct Reference {
  std::string waveform;  ///< "sine" or "square"
  double frequency_hz = 0.0;
  double amplitude_m = 0.0;
  double duration_s = 0.0;
};

/// Sine and square at 0.1, 1 and 10 Hz, with 86 006 samples at 1 kHz. The rig is hardly stiff,
/// because its leak is small and the orifice root is smoothed at 10 kPa.
inline const std::vector<Reference> kSixSignals{
    {"sine", 0.1, 0.0508, 30.0}, {"square", 0.1, 0.0508, 30.0}, {"sine", 1.0, 0.02, 10.0},
    {"square", 1.0, 0.02, 10.0}, {"sine", 10.0, 0.002, 3.0},    {"square", 10.0, 0.002, 3.0}};
model::ParameterValues six_signal_truth();

/// The paper's rig, with these signals (amplitude 2 inches) at each of these leakage coefficients.
inline const std::vector<Reference> kPaperSignals{
    {"sine", 0.1, 0.0508, 30.0},   {"square", 0.1, 0.0508, 30.0}, {"sine", 1.0, 0.0508, 10.0},
    {"square", 1.0, 0.0508, 10.0}, {"sine", 10.0, 0.0508, 3.0},   {"square", 10.0, 0.0508, 3.0}};
inline const std::vector<double> kPaperLeaks{0.001, 0.15, 0.6, 1.35};
model::ParameterValues paper_rig_truth();

std::vector<double> sample_times(const Reference& reference);
model::SimulationInputs inputs(const Reference& reference);

/// Standard deviation of a sample averaged over five repeats [m].
inline constexpr double kNoiseSd = 0.05e-3 / 2.2360679774997896;

struct Problem {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;
  std::vector<model::ParameterValues> truth;  ///< true values in each condition
};

/// Mass, bulk modulus, valve gain and leakage are free, and start away from the truth. The seed
/// determines the noise.
Problem six_signal_problem(unsigned seed = 1);
/// Mass, bulk modulus, valve gain and four leakage coefficients are free. There are 24 records with
/// 344 024 samples.
Problem stiff_problem(unsigned seed = 1);

/// Replaces the noise in the records.
void draw_noise(Problem& problem, unsigned seed);

}  // namespace rigcal::bench
