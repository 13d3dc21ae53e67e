#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;

/// A campaign file either loads or is rejected with the place of the error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto record =
      fuzz::scratch_file("record.csv", "t_s,x_mm\n0,0\n");  // a campaign may refer to it
  const auto file = fuzz::scratch_file("campaign.toml", fuzz::text_of_bytes(data, size));
  try {
    const datasets::Campaign campaign = datasets::load_campaign(file);
    check_values(campaign);
    for (const datasets::Condition& condition : campaign.conditions) {
      lacks_for_model(campaign, condition);
      values_in(campaign, condition);
    }
    leak_table_settings(campaign);
  } catch (const Error& error) {
    fuzz::require(error.code() == ExitCode::bad_input, "a bad campaign file is bad input");
  }
  return 0;
}
