#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "metrics/metric_table.hpp"
#include "python/arrays.hpp"
#include "python/described_members.hpp"
#include "python/fit_result.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
using datasets::Channel;

/// A channel of a scored condition. It keeps the condition alive.
struct ScoredChannel {
  std::shared_ptr<const calib::ConditionScore> condition;
  datasets::ChannelInfo about;
  calib::ChannelScore score;

  const std::vector<double>& measured() const { return series().first; }
  const std::vector<double>& simulated() const { return series().second; }

 private:
  const std::pair<std::vector<double>, std::vector<double>>& series() const {
    static const std::pair<std::vector<double>, std::vector<double>> kNone;
    const auto found = condition->series.find(about.channel);
    return found == condition->series.end() ? kNone : found->second;
  }
};

/// Returns the residual; empty if the condition could not be simulated.
py::array_t<double> residual(const ScoredChannel& self) {
  const std::vector<double>& measured = self.measured();
  const std::vector<double>& simulated = self.simulated();
  const std::size_t size = std::min(measured.size(), simulated.size());
  py::array_t<double> array(static_cast<py::ssize_t>(size));
  auto values = array.mutable_unchecked<1>();
  for (std::size_t i = 0; i < size; ++i)
    values(static_cast<py::ssize_t>(i)) = measured[i] - simulated[i];
  return array;
}

/// Returns the described numbers of a struct by name; None for one that does not exist.
template <typename Value = double, typename Numbers>
Dict<std::string, Value> by_name(const Numbers& numbers) {
  Dict<std::string, Value> values;
  Numbers::describe(numbers, [&](const char* name, double value) {
    values[name] = std::isnan(value) ? py::object(py::none()) : py::float_(value);
  });
  return values;
}

/// Returns a getter for a property with the numbers of a member that may be absent.
template <typename Numbers>
auto numbers_of(Numbers calib::ChannelScore::*member) {
  return [member](const ScoredChannel& self) -> std::optional<Dict<std::string, double>> {
    const auto& found = self.score.*member;
    if (!found) return std::nullopt;
    return by_name(*found);
  };
}

Dict<std::string, ScoredChannel> scored_channels_of(const ScoredCondition& self) {
  Dict<std::string, ScoredChannel> channels;
  for (const calib::ChannelScore& score : self.score->channels) {
    const datasets::ChannelInfo& about = info(score.channel);
    channels[py::str(about.key.data(), about.key.size())] = ScoredChannel{self.score, about, score};
  }
  return channels;
}

void bind_limit_check(py::module_& module) {
  using calib::LimitCheck;
  py::class_<LimitCheck> check(module, "LimitCheck", struct_doc<LimitCheck>());
  check.def_readonly("words", &LimitCheck::words, member_doc<LimitCheck>("words"));
  bind_members(module, check);
}

void bind_scored_channel(py::module_& module) {
  using calib::ChannelMetrics;
  using calib::ChannelScore;
  py::class_<ScoredChannel> channel(module, "ScoredChannel",
                                    "Agreement of the model with one channel of a condition; SI.");
  const auto add_numbers = [&](const char* name, auto member) {
    channel.def_property_readonly(name, numbers_of(member), member_doc<ChannelScore>(name));
  };
  const auto add_metric = [&](const char* name, auto member) {
    channel.def_property_readonly(
        name, [member](const ScoredChannel& self) { return self.score.metrics.*member; },
        member_doc<ChannelMetrics>(name));
  };
  add_numbers("noise_floor", &ChannelScore::noise_floor);
  add_numbers("expanded_uncertainty", &ChannelScore::expanded_uncertainty);
  add_numbers("two_sided_uncertainty", &ChannelScore::two_sided_uncertainty);
  add_metric("gain_ratio", &ChannelMetrics::gain_ratio);
  add_metric("phase_deg", &ChannelMetrics::phase_deg);
  add_metric("delay_s", &ChannelMetrics::delay_s);
  add_metric("problem", &ChannelMetrics::problem);
  channel
      .def_property_readonly("key", field(&ScoredChannel::about, &datasets::ChannelInfo::key),
                             "\"position\"...")
      .def_property_readonly("unit", field(&ScoredChannel::about, &datasets::ChannelInfo::unit),
                             "SI unit of the arrays.")
      .def_property_readonly(
          "measured",
          [](const ScoredChannel& self) { return view(self.condition, self.measured()); },
          "Mean of the repeats, shape (samples), in `unit`.")
      .def_property_readonly(
          "simulated",
          [](const ScoredChannel& self) { return view(self.condition, self.simulated()); },
          "Shape (samples), in `unit`; empty if it could not be simulated.")
      .def_property_readonly("residual", &residual,
                             "Measured minus simulated, shape (samples), in `unit`.")
      .def_property_readonly(
          "metrics",
          [](const ScoredChannel& self) {
            return by_name<std::optional<double>, metrics::Agreement>(self.score.metrics);
          },
          "Metrics by name, \"ccc\", \"rho2\"...; None if undefined.")
      .def_property_readonly(
          "budgets",
          [](const ScoredChannel& self) {
            return dict_of(self.score.score_budgets.value_or(Keyed<calib::Budget95>()));
          },
          member_doc<ChannelScore>("score_budgets"))
      .def("__repr__", [](const ScoredChannel& self) {
        return fmt::format("<rigcal.ScoredChannel {} of {}>", self.about.key, self.condition->id);
      });
}

}  // namespace

void bind_scores(py::module_& module) {
  using Self = ScoredCondition;
  bind_limit_check(module);
  bind_scored_channel(module);
  py::class_<Self> condition(
      module, "ScoredCondition",
      "Agreement of the model with the record of a condition; SI. Its arrays\nare read-only.");
  condition
      .def_property_readonly("checks", field(&Self::score, &calib::ConditionScore::limit_checks),
                             member_doc<calib::ConditionResult>("limit_checks"))
      .def_property_readonly(
          "time_s", [](const Self& self) { return view(self.score, self.score->time_s); },
          "Times [s], shape (samples of the whole record).")
      .def_property_readonly(
          "in_window",
          [](const Self& self) {
            py::array_t<bool> array(static_cast<py::ssize_t>(self.score->time_s.size()));
            auto values = array.mutable_unchecked<1>();
            for (std::size_t i = 0; i < self.score->time_s.size(); ++i)
              values(static_cast<py::ssize_t>(i)) =
                  self.score->in_window.empty() || self.score->in_window[i];
            return array;
          },
          "Whether each sample is scored, shape (samples).")
      .def_property_readonly(
          "drive", [](const Self& self) { return view(self.score, self.score->drive); },
          "Reference [m], or command [V] in open loop, shape (samples).")
      .def_property_readonly(
          "servo_flow_m3_per_s",
          [](const Self& self) { return view(self.score, self.score->servo_flow_m3_per_s); },
          "Simulated, shape (samples) [m3/s]; empty if it could not be simulated.")
      .def_property_readonly(
          "leakage_flow_m3_per_s",
          [](const Self& self) { return view(self.score, self.score->leakage_flow_m3_per_s); },
          "Simulated, shape (samples) [m3/s]; empty if it could not be simulated.")
      .def_property_readonly("channels", &scored_channels_of, "Channels by key: \"position\".")
      .def("__repr__", [](const Self& self) {
        return fmt::format("<rigcal.ScoredCondition {}: {}>", self.score->id,
                           self.score->verdict ? to_string(*self.score->verdict) : "no limits");
      });
  bind_members_of<calib::ConditionResult>(
      module, condition,
      [](const Self& self) -> const calib::ConditionResult& { return *self.score; },
      {"limit_checks"});
}

}  // namespace rigcal::python
