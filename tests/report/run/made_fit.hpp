#pragma once

#include <atomic>
#include <stdexcept>
#include <vector>

#include "datasets/prepare/load_record.hpp"
#include "report/run/fit_choices.hpp"
#include "report/store/result.hpp"
#include "tests/report/run/made_rig.hpp"

namespace rigcal::test {

/// A fit to the synthetic records of MadeRig.
struct MadeFit : MadeRig {
  MadeFit() {
    report::apply({}, settings);
    fit = calib::fit(campaign, records, settings);
    if (!fit.has_converged()) throw std::runtime_error("the fit of the tutorial's rig has failed");
  }

  report::Result result() const {
    return {report::ResultKind::fit, campaign, records, fit, provenance};
  }

  datasets::Campaign campaign = load(choice);
  std::vector<datasets::Record> records =
      datasets::load_records(campaign, {datasets::Use::fit, datasets::Use::validate}, 1, true);
  std::atomic<bool> cancel{false};
  calib::FitOptions settings = report::fit_options(campaign, 1, cancel);
  report::Provenance provenance =
      report::provenance_of_starts("rigcal fit", recorded(choice), {}, settings, campaign, records);
  calib::Fit fit;
};

}  // namespace rigcal::test
