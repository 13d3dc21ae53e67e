#include "calib/result/considered.hpp"

#include <algorithm>

namespace rigcal::calib {

const ConsideredEffect* Considered::find(std::string_view key) const {
  const auto found = std::find_if(effects.begin(), effects.end(),
                                  [&](const ConsideredEffect& each) { return each.key == key; });
  return found == effects.end() ? nullptr : &*found;
}

}  // namespace rigcal::calib
