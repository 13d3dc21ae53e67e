#include "report/live/live_module.hpp"

#include <cstddef>

extern "C" {
extern const char rigcal_live_module_begin[];
extern const char rigcal_live_module_end[];
}

namespace rigcal::report {

std::string_view live_module() {
  return {rigcal_live_module_begin,
          static_cast<std::size_t>(rigcal_live_module_end - rigcal_live_module_begin)};
}

}  // namespace rigcal::report
