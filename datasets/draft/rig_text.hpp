#pragma once

#include <optional>
#include <string>

#include "model/simulate.hpp"

namespace rigcal::datasets {

/// What the recorded channels say about the terms of a rig.
struct RecordedSigns {
  bool payload = false;      ///< an acceleration was recorded
  bool load_table = false;   ///< position and both chamber pressures were recorded
  bool pilot = false;        ///< the drive is a pilot pressure
  bool temperature = false;  ///< a temperature was recorded
  bool position = false;     ///< a position was recorded
  bool pressures = false;    ///< a load pressure or both chamber pressures were recorded
  bool supply = false;       ///< a supply pressure was recorded
  bool command = false;      ///< a voltage or current drives the valve
  bool spool = false;        ///< the position of a spool was recorded
};

/// Returns the text of [rig]: blanks for what every rig of the plant has, and as comments the terms
/// that the recorded channels suggest.
/// @param loop  controlled quantity; nullopt if the command was recorded
std::string rig_text(model::PlantKind plant, std::optional<model::Feedback> loop,
                     const RecordedSigns& signs);

}  // namespace rigcal::datasets
