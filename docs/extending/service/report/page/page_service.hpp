#pragma once

#include <string>
#include <vector>

#include "report/page/section.hpp"

// service.json: what was done to the rig, as the laboratory's own script writes it.

namespace rigcal::report {

struct ServiceEntry {
  std::string date;
  double operating_hours = 0.0;
  std::string what;
  RIGCAL_DESCRIBE(date, operating_hours, what)
};

struct Service {
  std::string schema = "rigcal.service/1";
  std::string campaign;
  std::vector<ServiceEntry> entries;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(schema, campaign, entries, provenance)
};

Service load_service(const ReadFile& read, const std::string& where);
doc::Verdict service_headline(const Service& service);
std::vector<doc::Section> service_sections(const Service& service);
std::vector<Figure> service_figures(const Service& service);

}  // namespace rigcal::report
