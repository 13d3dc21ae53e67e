#include "datasets/checks/drive_motion.hpp"

#include <algorithm>
#include <vector>

#include "datasets/checks/median.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kParts = 4;
constexpr double kTenth = 0.1;

double range(std::span<const double> x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

}  // namespace

double drive_motion(std::span<const double> drive, const EqualRun& run) {
  const double whole = range(drive);
  if (!(whole > 0.0)) return 0.0;
  const auto part = drive.subspan(run.begin, run.length);
  if (part.size() < 2 * kParts) return range(part) / whole;
  std::vector<double> medians;
  for (std::size_t k = 0; k < kParts; ++k) {
    const std::size_t begin = k * part.size() / kParts;
    const std::size_t end = (k + 1) * part.size() / kParts;
    const auto own = part.subspan(begin, end - begin);
    medians.push_back(median({own.begin(), own.end()}));
  }
  return range(medians) / whole;
}

int drive_passages(std::span<const double> drive, const EqualRun& run) {
  const auto [low, high] = std::minmax_element(drive.begin(), drive.end());
  const double near = kTenth * (*high - *low);
  if (!(near > 0.0)) return 0;
  int passages = 0;
  int side = 0;
  for (const double value : drive.subspan(run.begin, run.length)) {
    const int now = value <= *low + near ? -1 : value >= *high - near ? 1 : 0;
    if (now == 0) continue;
    if (side != 0 && now != side) ++passages;
    side = now;
  }
  return passages;
}

}  // namespace rigcal::datasets
