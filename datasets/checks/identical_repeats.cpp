#include "datasets/checks/identical_repeats.hpp"

#include "datasets/checks/equal_runs.hpp"

namespace rigcal::datasets {
std::vector<std::size_t> first_identical(const std::vector<Repeat>& repeats,
                                         const std::vector<std::size_t>& carriers,
                                         Channel channel) {
  std::vector<std::size_t> first(carriers.size());
  for (std::size_t k = 0; k < carriers.size(); ++k) {
    first[k] = k;
    const auto& own = repeats[carriers[k]].values.at(channel);
    if (!info(channel).is_output || is_constant(own)) continue;
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      if (repeats[carriers[earlier]].values.at(channel) != own) continue;
      first[k] = earlier;
      break;
    }
  }
  return first;
}

}  // namespace rigcal::datasets
