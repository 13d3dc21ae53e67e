#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;

/// If a campaign loads, the fitted.toml written from it loads, too.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto record =
      fuzz::scratch_file("record.csv", "t_s,x_mm\n0,0\n");  // a campaign may refer to it
  const auto file = fuzz::scratch_file("campaign.toml", fuzz::text_of_bytes(data, size));
  std::string text;
  try {
    const datasets::Campaign campaign = datasets::load_campaign(file);
    text = fitted_campaign_text(campaign, {}, fuzz::scratch_folder());
  } catch (const InputError&) {
    return 0;
  }
  const auto fitted = fuzz::scratch_file("fitted.toml", text);
  const datasets::Campaign again = datasets::load_campaign(fitted);
  // The first line names the file from which it was written.
  const std::string written = fitted_campaign_text(again, {}, fuzz::scratch_folder());
  fuzz::require(written.substr(written.find('\n')) == text.substr(text.find('\n')),
                "written again, fitted.toml is the same");
  return 0;
}
