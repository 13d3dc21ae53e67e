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

Json service_headline(const Service& service) {
  if (service.entries.empty())
    return make_headline("NO SERVICE", "!", "warn", "Nothing was ever done to the rig.");
  const ServiceEntry& last = service.entries.back();
  return make_headline(
      "SERVICED", "✓", "good",
      fmt::format("Last on {}, at {:g} h: {}.", last.date, last.operating_hours, last.what));
}

Json service_view(const Service& service) {
  Json view;
  view["rows"] = Json::array();
  for (const ServiceEntry& entry : service.entries) {
    view["rows"].push_back({{"date", entry.date},
                            {"hours", shown_in(entry.operating_hours, 1.0)},
                            {"what", entry.what}});
  }
  view["plot_html"] = svg(hours_plot(service));
  return view;
}

std::vector<Figure> service_figures(const Service& service) {
  return {{"service", hours_plot(service)}};
}

}  // namespace rigcal::report
