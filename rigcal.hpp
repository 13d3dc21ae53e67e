#pragma once

// The entry to rigcal's libraries: all that a program needs to read a campaign, simulate its rig,
// fit and judge the model, find leaks, and write whole results with their pages. Installed as
// rigcal/rigcal.hpp, with the headers that it includes and no others. docs/install.md has an
// example.

#include "calib/fit.hpp"
#include "common/error.hpp"
#include "common/quantity.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/synthetic/synthesize.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/parity/parity.hpp"
#include "metrics/agreement.hpp"
#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"
#include "report/job/job.hpp"
#include "report/store/provenance.hpp"
