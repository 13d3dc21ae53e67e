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

/// A fit or validation with all that its files are made from. Borrows everything.
struct Result {
  ResultKind kind = ResultKind::fit;
  const datasets::Campaign& campaign;
  const std::vector<datasets::Record>& records;
  const calib::Fit& fit;
  const Provenance& provenance;
};

/// Status of a result in its files. A fit that claims to have converged but has a value that is not
/// finite has failed.
inline calib::FitStatus status_of(const calib::Fit& fit) {
  if (fit.status == calib::FitStatus::converged && !fit.usable()) return calib::FitStatus::failed;
  return fit.status;
}

}  // namespace rigcal::report
