#include "bench/foreign_day.hpp"

#include <fmt/format.h>

#include <boost/random/normal_distribution.hpp>

namespace rigcal::bench {

DaySizes times(double factor, const DaySizes& sizes) {
  return {factor * sizes.supply, factor * sizes.bulk_modulus, factor * sizes.zero_m,
          factor * sizes.trigger_s};
}

ForeignRig rig_of_day(ForeignRig rig, const DaySizes& sizes, boost::random::mt19937_64& stream) {
  boost::random::normal_distribution<double> normal;
  rig.supply_pa *= 1.0 + sizes.supply * normal(stream);
  rig.bulk_modulus_pa *= 1.0 + sizes.bulk_modulus * normal(stream);
  rig.sensor_offset_m += sizes.zero_m * normal(stream);
  rig.delay_s += sizes.trigger_s * normal(stream);
  return rig;
}

datasets::StatedSizes stated_days(const ForeignRig& rig, const DaySizes& sizes) {
  datasets::StatedSizes stated;
  stated.sizes["supply_pressure"] = sizes.supply * rig.supply_pa;
  stated.sizes["bulk_modulus"] = sizes.bulk_modulus * rig.bulk_modulus_pa;
  stated.sizes["position_offset"] = sizes.zero_m;
  stated.sizes[datasets::kTriggerKey] = sizes.trigger_s;
  return stated;
}

std::string date_of(int day) {
  return fmt::format("2026-{:02d}-{:02d}", 1 + day / 28, 1 + day % 28);
}

}  // namespace rigcal::bench
