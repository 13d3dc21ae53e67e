#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calib/fit.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

enum class ResultKind { fit, validation };

/// A fit or validation with all data for its result files. Borrows everything.
struct Result {
  ResultKind kind = ResultKind::fit;
  const datasets::Campaign& campaign;
  const std::vector<datasets::Record>& records;
  const calib::Fit& fit;
  const Provenance& provenance;
};

/// Returns the status of a result in its files. A converged fit with a value that is not finite
/// counts as failed.
inline calib::FitStatus status_of(const calib::Fit& fit) {
  if (fit.status == calib::FitStatus::converged && !fit.usable()) return calib::FitStatus::failed;
  return fit.status;
}

}  // namespace rigcal::report
