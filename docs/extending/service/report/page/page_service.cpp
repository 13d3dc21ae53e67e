#include "report/page/page_service.hpp"

#include <fmt/format.h>

namespace rigcal::report {
namespace {

Plot hours_plot(const Service& service) {
  Plot plot;
  plot.title = "Hours of operation at each service";
  plot.x_label = "service";
  plot.y_label = "hours of operation [h]";
  plot.whole_x = true;
  Trace points = empty_trace(Trace::Kind::points, "measured");
  for (const ServiceEntry& entry : service.entries) {
    points.x.push_back(static_cast<double>(points.x.size() + 1));
    points.y.push_back(entry.operating_hours);
  }
  plot.traces = {std::move(points)};
  return plot;
}

}  // namespace

Service load_service(const ReadFile& read, const std::string& where) {
  return load<Service>(read, where, "service.json");
}

doc::Verdict service_headline(const Service& service) {
  if (service.entries.empty())
    return {{doc::State::warn, "NO SERVICE"}, {"Nothing was ever done to the rig."}};
  const ServiceEntry& last = service.entries.back();
  return {{doc::State::good, "SERVICED"},
          {fmt::format("Last on {}, at {:g} h: {}.", last.date, last.operating_hours, last.what)}};
}

std::vector<doc::Section> service_sections(const Service& service) {
  doc::Table table{"What was done to the rig"};
  table.columns = {{"Date"}, {"Hours of operation", doc::Column::Kind::number}, {"What"}};
  for (const ServiceEntry& entry : service.entries)
    table.rows.push_back({{entry.date, doc::in_unit(entry.operating_hours, 1.0), entry.what}});
  return {{"service", "Service", {std::move(table), figure_of(hours_plot(service))}}};
}

std::vector<Figure> service_figures(const Service& service) {
  return {{"service", hours_plot(service)}};
}

}  // namespace rigcal::report
