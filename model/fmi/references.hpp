#pragma once

// Value references of an FMU: the numbers by which an importer identifies a variable. The model
// description and the instance both use them.

namespace rigcal::model {

inline constexpr unsigned kInputReference = 0;         ///< in the order of RigInputs
inline constexpr unsigned kStateReference = 100;       ///< in the order of Layout
inline constexpr unsigned kDerivativeReference = 200;  ///< in the order of Layout
inline constexpr unsigned kOutputReference = 300;      ///< in the order of Output
inline constexpr unsigned kParameterReference =
    1000;  ///< plus the row in the plant's parameter table

inline constexpr unsigned kInputCount = 4;

}  // namespace rigcal::model
