#pragma once

#include <optional>
#include <span>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/signal/signal.hpp"

namespace rigcal::datasets {

/// A recorded drive that is one which the model generates.
struct RecognisedDrive {
  model::Signal signal = model::Signal::constant(0.0);
  std::string name;        ///< "a sine of 10 Hz with an amplitude of 0.0508 m"
  double farthest = 0.0;   ///< of a sample from it, unit of the drive
  double tolerance = 0.0;  ///< how far a sample may be
};

/// Recognises a sine (with offset and phase), a square wave or a chirp, where every sample of a
/// recorded drive is what the generated signal is there, to the rounding of the record: three
/// quarters of the step of its converter or digits. Where the campaign states the noise of the
/// channel (`sd`), five times that, and 1.2 times that in the mean square. Noise that is not stated
/// is not guessed: what looks like it may be what moved the rig.
///
/// @param time_s  shape (n), increasing
/// @param drive   shape (n), SI
/// @param unit    of the drive, for its name
/// @param sd      of its noise; 0: none is stated
std::optional<RecognisedDrive> recognised_drive(std::span<const double> time_s,
                                                std::span<const double> drive,
                                                const std::string& unit, double sd);

/// Enters into a record what its recorded drive is, with a note; nothing where the campaign says
/// `recognise = false` of the channel, or the condition is generated anyway.
void recognise_drive(const Campaign& campaign, const Condition& condition, Record& record);

}  // namespace rigcal::datasets
