#pragma once

#include <optional>
#include <span>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/signal/signal.hpp"

namespace rigcal::datasets {

/// A recorded drive that the model can generate.
struct RecognisedDrive {
  model::Signal signal = model::Signal::constant(0.0);
  std::string name;        ///< "a sine of 10 Hz with an amplitude of 0.0508 m"
  double farthest = 0.0;   ///< largest deviation of a sample, in the unit of the drive
  double tolerance = 0.0;  ///< largest deviation that is accepted
};

/// Recognises a sine (with offset and phase), a square wave or a chirp. Every sample of the
/// recorded drive must match the generated signal within the rounding of the record: three quarters
/// of a step of its converter or of its last digit. If the campaign states the noise of the channel
/// (`sd`), the tolerance increases by five times `sd`, and the rms deviation may be up to 1.2 times
/// `sd`. Noise that is not stated is not estimated, because it may be real motion of the rig. A
/// sample at the instant of an edge of a square wave may have any value between the two levels, as
/// simulation programs write it.
///
/// @param time_s  shape (n), increasing
/// @param drive   shape (n), SI
/// @param unit    unit of the drive, for use in its name
/// @param sd      standard deviation of its noise; 0 if not stated
std::optional<RecognisedDrive> recognised_drive(std::span<const double> time_s,
                                                std::span<const double> drive,
                                                const std::string& unit, double sd);

/// Replaces a recorded drive with the generated signal that it equals, and adds a note. Does
/// nothing if the campaign sets `recognise = false` for the channel, or if the drive is generated
/// already.
void recognise_drive(const Campaign& campaign, const Condition& condition, Record& record);

}  // namespace rigcal::datasets
