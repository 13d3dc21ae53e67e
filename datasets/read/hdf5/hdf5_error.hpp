#pragma once

#include <hdf5.h>

#include <string>

namespace rigcal::datasets {

/// Returns the reason that HDF5 gives for its last failure: the outermost entry of its error stack.
inline std::string hdf5_reason() {
  std::string reason = "no reason given";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* text) -> herr_t {
        if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
        return 0;
      },
      &reason);
  return reason;
}

}  // namespace rigcal::datasets
