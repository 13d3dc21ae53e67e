#include "report/leak/leak_table.hpp"

namespace rigcal::report {

StoredLeakTable stored(const LeakTableResult& result) {
  StoredLeakTable file;
  static_cast<calib::LeakTable&>(file) = result.table;
  file.campaign = result.campaign.name;
  file.notes = result.notes;
  file.warnings = result.warnings;
  file.provenance = stored(result.provenance);
  return file;
}

}  // namespace rigcal::report
