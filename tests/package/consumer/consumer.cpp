// What a program of one's own does with the installed libraries: reads a campaign and fits it.
#include <cstddef>
#include <cstdio>
#include <exception>

#include "calib/fit.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/load_record.hpp"
#include "model/plant/parameter.hpp"
#include "report/store/provenance.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    using rigcal::datasets::Use;
    const rigcal::datasets::Campaign campaign = rigcal::datasets::load_campaign(argv[1]);
    const auto records = rigcal::datasets::load_records(campaign, {Use::fit, Use::validate}, 1);
    const rigcal::calib::Fit fit = rigcal::calib::fit(campaign, records, {});
    std::printf("%s by rigcal %s:\n", campaign.name.c_str(), rigcal::report::version().data());
    const auto table = rigcal::model::parameter_table(campaign.rig.plant);
    for (const auto& parameter : fit.parameters) {
      const auto& spec = table[static_cast<std::size_t>(parameter.index)];
      if (parameter.fitted) std::printf("%s %.6g\n", spec.key.data(), parameter.value);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
  return 0;
}
