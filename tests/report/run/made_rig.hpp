#pragma once

#include <filesystem>
#include <string>

#include "datasets/synthetic/synthesize.hpp"
#include "report/run/campaign_choice.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {

/// Synthetic records of the tutorial's rig, in a folder that is deleted after the test.
class MadeRig {
 public:
  MadeRig() {
    const auto known = datasets::load_campaign(RIGCAL_SOURCE_DIR "/docs/tutorial/known_rig.toml");
    choice.campaign = datasets::synthesize(known, 1, folder / "data", 1).campaign_file;
  }

  TemporaryFolder folder;
  report::CampaignChoice choice;
};

}  // namespace rigcal::test
